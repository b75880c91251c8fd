//! Constraints compared with MuJoCo 3.14.0, with both sides solved up to rounding; recorded by `golden/constrained.py`.
//!
//! Our own models (`golden/constrained/*.xml`) have every kind of row with every option, and are compared field by field. For
//! the models of `../shared`, accelerations, forces, sensors and a hundred steps are compared. If the numbers of contacts
//! differ, nothing else can agree, and the table states this.
//!
//! Differences are absolute for numbers up to 1 and relative above, scaled by the largest recorded number of the field.

#![allow(clippy::unwrap_used, clippy::panic)]

use crate::needs::needs;
use crate::recorded::{Verdict, list, named, objects, set, trajectory, worst};
use crate::support::{models, numbers, read_json, workspace};
use crate::zoo::ORDER;
use labspec_core::reflect::{self, Object};
use labspec_core::xml::{self, MjcfFileError};
use labspec_core::{self as core, Data, Error, Model};
use serde_json::Value;
use std::fmt::Write;
use std::path::Path;

/// The tolerance of constraint rows, which result from a few products.
const ROWS: f64 = 1e-10;
/// The tolerance of the solution: the library's solution is not more accurate.
const SOLVED: f64 = 1e-8;

/// The tolerance after a hundred steps with the solver settings of the model: the library stops when an improvement
/// falls below its tolerance.
const PATH: f64 = 1e-6;

/// Fields that depend on the solution.
const SOLUTION: [&str; 8] =
    ["qacc", "qfrc_constraint", "sensordata", "efc_force", "efc_state", "cfrc_ext", "cfrc_int", "cacc"];

/// The causes of differences of trajectories that are not chaos.
const REASONS: [(&str, &str); 5] = [
    ("conformance/engine__actuation__refsite_free", ORDER),
    (
        "conformance/engine__solver__humanoid",
        "the library's projected Gauss–Seidel stays at the apex of a cone where a push pays only with the friction that it \
         allows; ours leaves it, for the answer of Newton's method",
    ),
    ("conformance/user__robot_arm", BESIDE_AN_END),
    ("conformance/mjx__humanoid__02_humanoids", CUT_SHORT),
    ("conformance/mjx__humanoid__humanoid", CUT_SHORT),
];

/// The causes of differences of forward passes or of the number of contacts.
const FORWARD: [(&str, &str); 3] = [
    ("conformance/engine__actuation__refsite_free", ORDER),
    (
        "conformance/engine__sensor__fromto_capsule_ellipsoid",
        "the library stops within `ccd_tolerance` of the nearest points of a capsule and an ellipsoid",
    ),
    ("conformance/user__robot_arm", BESIDE_AN_END),
];

/// A capsule that lies on a cylinder.
const BESIDE_AN_END: &str = "a capsule on a cylinder, 2e-6 rad from parallel: the library's deepest point is 4e-4 m from where \
                             it is, at an end that rocking finds again; here it is a third contact beside both ends";

/// `iterations="1" ls_iterations="4"`: the result is only the point where the search was stopped. When solved tightly, both
/// sides agree (see the forward passes of this table).
const CUT_SHORT: &str =
    "the model allows one iteration with four evaluations along the line: each side stops on its own way";

/// Cases of our own models, (model, case), whose solution differs from the library's: for a contact with a singular matrix of
/// tangents, `noslip` of the library keeps the friction of the main solver (docs/measured/parity.md).
/// `crates/core/tests/laws/constraints.rs` checks the optimality conditions of our solution.
const LEFT_TO_SLIP: [(&str, &str); 2] = [("contacts", "ellipse noslip"), ("contacts", "ellipse dual noslip")];

/// The maximum number of chaotic models: when its start moves by 1e-14, the library differs from itself as
/// much as from our engine.
const MOST_CHAOTIC: usize = 3;

/// The result of the comparison of a model.
enum Outcome {
    Same { rows: f64, solution: f64 },
    Contacts(String),
    Refused(String),
    Differs(Vec<String>),
}

fn options(m: &mut Model, chosen: &Value) {
    let mut d = Data::new(m);
    for (name, value) in objects(chosen) {
        let field = reflect::field(Object::Option, name).unwrap();
        let values = value.as_array().map_or(vec![value.clone()], Clone::clone);
        for (i, v) in values.iter().enumerate() {
            core::view_mut(m, &mut d, field).unwrap().set(i, v.as_f64().unwrap());
        }
    }
}

fn tight(m: &mut Model) {
    (*m.edit().opt.tolerance, *m.edit().opt.ls_tolerance) = (0.0, 1e-10);
    (*m.edit().opt.iterations, *m.edit().opt.ls_iterations) = (200, 100);
}

/// A lower bound of the rounding error of a sum of the forces of all rows: if only the smallest number makes rows soft, bodies
/// that are stuck in each other push with 1e18 N.
fn rounding_of_forces(d: &Data) -> f64 {
    d.efc_force.iter().map(|f| f.abs() * f64::EPSILON).sum()
}

fn compare_with_recording(path: &Path, recording: &Value) -> Outcome {
    let mut compiled = match xml::compile_file(path) {
        Ok(m) => m,
        Err(Error::File(MjcfFileError::Model { diagnostics, .. })) => {
            return Outcome::Refused(diagnostics.first().map_or(String::new(), |d| d.message.clone()));
        }
        Err(other) => return Outcome::Refused(other.to_string()),
    };
    tight(&mut compiled);
    let (mut rows, mut solution): (f64, f64) = (0.0, 0.0);
    let mut found = Vec::new();
    for case in recording["cases"].as_array().unwrap() {
        let mut m = compiled.clone();
        options(&mut m, &case["options"]);
        let mut d = Data::new(&m);
        for (k, row) in case["states"].as_array().unwrap().iter().enumerate() {
            set(&m, &mut d, &row["state"]);
            core::forward(&m, &mut d).unwrap();
            core::rne_post_constraint(&m, &mut d).unwrap();
            let at = format!("{} state {k}", case["case"].as_str().unwrap());
            // Our own models record other fields, all of which are compared.
            let recorded = row["data"].get("ncon").map_or(d.ncon as f64, |v| numbers(v)[0]);
            if d.ncon as f64 != recorded {
                return Outcome::Contacts(format!("{at}: {} contacts, theirs {recorded}", d.ncon));
            }
            for (name, values) in objects(&row["data"]) {
                let field = named(Object::Data, name);
                let (computed, recorded) = (list(&m, &d, field), numbers(values));
                let mut scale = recorded.iter().fold(1.0, |s: f64, x| s.max(x.abs()));
                if name == "qfrc_constraint" {
                    // The rounding errors of the terms bound the accuracy of a sum.
                    scale = scale.max(rounding_of_forces(&d) / SOLVED);
                }
                let (index, difference) = worst(&computed, &recorded, scale);
                let solved = SOLUTION.contains(&name.as_str());
                let (most, limit) = if solved { (&mut solution, SOLVED) } else { (&mut rows, ROWS) };
                *most = most.max(difference);
                if difference > limit {
                    let number = |list: &[f64]| list.get(index).copied().unwrap_or(f64::NAN);
                    found.push(format!(
                        "{at}, {name}[{index}]: ours {:?}, theirs {:?} ({difference:.1e})",
                        number(&computed),
                        number(&recorded)
                    ));
                }
            }
        }
    }
    if found.is_empty() { Outcome::Same { rows, solution } } else { Outcome::Differs(found) }
}

/// Our own models: all fields agree.
#[test]
fn rows_and_forces_are_those_of_mujoco() {
    let folder = workspace().join("tests/golden/constrained");
    let (mut wrong, mut exceptions) = (String::new(), 0);
    for name in models(&folder) {
        let recording = read_json(&folder.join(format!("{name}.json")));
        match compare_with_recording(&folder.join(format!("{name}.xml")), &recording) {
            Outcome::Same { rows, solution } => {
                println!("{name}: rows {rows:.1e} apart at most, solution {solution:.1e}")
            }
            Outcome::Contacts(what) | Outcome::Refused(what) => drop(writeln!(wrong, "{name}: {what}")),
            Outcome::Differs(list) => {
                let listed = |line: &&String| {
                    let solution = SOLUTION.iter().any(|field| line.contains(&format!(", {field}[")));
                    let of = |(model, case): &(&str, &str)| {
                        *model == name && line.starts_with(&format!("{case} state"))
                    };
                    solution && LEFT_TO_SLIP.iter().any(of)
                };
                let (expected, others): (Vec<_>, Vec<_>) = list.iter().partition(listed);
                exceptions += expected.len();
                others.iter().for_each(|line| {
                    let _ = writeln!(wrong, "{name}: {line}");
                });
            }
        }
    }
    assert!(exceptions > 0, "the cases that are listed as left to slip do not differ");
    assert!(wrong.is_empty(), "differences from MuJoCo 3.14.0:\n{wrong}");
}

/// The models of `../shared`; the table `golden/constrained.md` lists which agree.
#[test]
fn shared_models_with_constraints() {
    let shared = workspace().join("../shared");
    if !needs("../shared/conformance") {
        return;
    }
    let recordings = workspace().join("tests/golden/constrained");
    let (mut table, mut counts, mut paths) = (String::new(), [0; 4], [0; 4]);
    let mut wrong = String::new();
    for (kind, folder) in
        [("conformance", "conformance/models"), ("corpus", "corpus/models"), ("bench", "bench")]
    {
        for name in models(&shared.join(folder)) {
            let recording = read_json(&recordings.join(kind).join(format!("{name}.json")));
            let model = shared.join(folder).join(format!("{name}.xml"));
            let outcome = compare_with_recording(&model, &recording);
            if let Ok(m) = xml::compile_file(&model) {
                let start = &recording["cases"][0]["states"][0]["state"];
                let path = trajectory(&m, start, &recording["trajectory"], PATH);
                let class = match &path {
                    Verdict::Same(_) => 0,
                    Verdict::Sensitive(..) => 1,
                    Verdict::Refused(_) => 2,
                    Verdict::Differs(list) => {
                        let why = REASONS.iter().find(|(of, _)| *of == format!("{kind}/{name}"));
                        if why.is_none() {
                            let _ = writeln!(wrong, "{kind}/{name} differs on its way: {}", list[0]);
                        }
                        let why = why.map_or(String::new(), |(_, why)| format!(": {why}"));
                        let _ = writeln!(table, "| {kind}/{name} | trajectory | {}{why} |", list[0]);
                        3
                    }
                };
                paths[class] += 1;
            }
            let (class, text) = match outcome {
                Outcome::Same { rows, solution } => {
                    println!("{kind}/{name}: ok, rows {rows:.1e}, solution {solution:.1e}");
                    (0, String::new())
                }
                Outcome::Contacts(what) => (1, format!("contacts | {what}")),
                Outcome::Refused(what) => (2, format!("refused | {what}")),
                Outcome::Differs(list) => {
                    println!("{kind}/{name} differs:\n    {}", list.join("\n    "));
                    (3, format!("differs | {}", list[0]))
                }
            };
            counts[class] += 1;
            if class > 0 {
                let why = FORWARD.iter().find(|(of, _)| class != 2 && *of == format!("{kind}/{name}"));
                if why.is_none() {
                    let _ = writeln!(wrong, "{kind}/{name}: {text}");
                }
                let why = why.map_or(String::new(), |(_, why)| format!(": {why}"));
                let _ = writeln!(table, "| {kind}/{name} | {}{why} |", text.replace('\n', " "));
            }
        }
    }
    let [same, contacts, refused, differs] = counts;
    let [along, chaotic, impossible, unexplained] = paths;
    let text = format!(
        "# Models with constraints held against MuJoCo 3.14.0\n\nWritten by `tests/constrained.rs`: forward passes, both \
         sides solved to rounding.\n\n{same} the same within {SOLVED:.0e}, {contacts} with other contacts, {refused} \
         refused, {differs} differ.\n\nA hundred steps from the start with the solver as the model has it: {along} the same within \
         {PATH:.0e}, {chaotic} chaotic, {impossible} refused there, {unexplained} differ.\n\n| model | outcome | where |\n|---|---|---|\n{table}"
    );
    // More differences than listed are a failure, independent of the table.
    if unexplained != REASONS.len() {
        let _ =
            writeln!(wrong, "{unexplained} differ on their way, {} are listed with a reason", REASONS.len());
    }
    if contacts + differs != FORWARD.len() {
        let _ = writeln!(wrong, "{} forward passes differ, {} are listed", contacts + differs, FORWARD.len());
    }
    if chaotic > MOST_CHAOTIC {
        let _ = writeln!(wrong, "{chaotic} are chaotic, {MOST_CHAOTIC} may be");
    }
    if impossible > 0 {
        let _ = writeln!(wrong, "{impossible} recordings hold nothing");
    }
    assert!(wrong.is_empty(), "worse than before:\n{wrong}");
    let path = workspace().join("tests/golden/constrained.md");
    if std::env::var_os("LABSPEC_BLESS").is_some() {
        std::fs::write(&path, &text).unwrap();
    }
    let stored = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(
        stored == text,
        "tests/golden/constrained.md is stale: LABSPEC_BLESS=1 cargo test -p labspec-cli constrained"
    );
}
