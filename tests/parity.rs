//! Values of MuJoCo 3.14.0, recorded by `golden/record.py`, compared with ours.
//!
//! Three things are compared: the compiled model, every field after a forward pass in eight states, and whole trajectories with
//! the number of contacts and constraint rows of every step. Differences are absolute for numbers up to 1 and relative above,
//! scaled by the largest recorded number of the field, because a force of 1e4 N cannot be accurate to 1e-9 N.

#![allow(clippy::unwrap_used, clippy::panic)]

use crate::recorded::{list, start, worst};
use crate::support::{compile, model_text, numbers, recording};
use labspec_core::reflect::{self, Object};
use labspec_core::{self as core, Contact, Data, Model, Warning};
use serde_json::Value;
use std::fmt::Write;

/// A recorded case, with the tolerance of its trajectory.
struct Case {
    name: &'static str,
    /// The largest difference of `qpos` and `qvel` at any recorded step.
    trajectory: f64,
}

const fn case(name: &'static str, trajectory: f64) -> Case {
    Case { name, trajectory }
}

/// Only rounding: the same formulas, summed in another order, over the recorded number of steps.
const ROUNDING: f64 = 1e-12;
/// With contacts and limits, the library's solver stops when an improvement falls below its tolerance of 1e-8 times the scale
/// of the problem, and ours at the solution. This is the remaining difference over the run.
const SOLVED: f64 = 1e-10;

const CASES: &[Case] = &[
    case("free_fall", 0.0),
    case("ball_drop", SOLVED),
    case("ball_drop_20ms", SOLVED),
    case("pendulum", ROUNDING),
    case("double_pendulum", ROUNDING),
    case("double_pendulum_rk4", ROUNDING),
    case("ball_pendulum", ROUNDING),
    case("springs", ROUNDING),
    case("limits", SOLVED),
    case("spin", ROUNDING),
    case("spin_rk4", ROUNDING),
    case("collision", SOLVED),
    case("stack", SOLVED),
    case("stack_rk4", SOLVED),
    case("rolling", SOLVED),
    case("rolling_impratio", SOLVED),
    case("mocap", SOLVED),
    case("margin", SOLVED),
    case("materials", SOLVED),
    case("mixing", SOLVED),
    case("override", SOLVED),
    case("tree", SOLVED),
    case("tree_rk4", SOLVED),
    case("everything", SOLVED),
    case("no_constraint", ROUNDING),
    case("no_limit", SOLVED),
    case("no_contact", SOLVED),
    case("no_spring", SOLVED),
    case("no_damper", SOLVED),
    case("no_gravity", SOLVED),
    case("no_warmstart", SOLVED),
    case("no_filterparent", SOLVED),
    case("no_refsafe", SOLVED),
    case("no_eulerdamp", SOLVED),
    case("no_island", SOLVED),
    case("no_passive", SOLVED),
];

/// The tolerance of a forward pass, with both solvers running up to rounding: condition numbers up to 1e4
/// times the unit roundoff.
const FORWARD: f64 = 1e-11;
/// The compiler performs only a few products and one diagonalization.
const COMPILED: f64 = 1e-12;

/// The model of a case, with its options.
fn load(case: &Value) -> Model {
    let mut m = compile(&model_text(case["model"].as_str().unwrap()));
    let mut scratch = Data::new(&m);
    for (name, values) in case["options"].as_object().unwrap() {
        let field = reflect::field(Object::Option, name).unwrap();
        for (i, x) in numbers(values).into_iter().enumerate() {
            assert!(labspec_core::view_mut(&mut m, &mut scratch, field).unwrap().set(i, x), "{name}[{i}]");
        }
    }
    m
}

/// Differences above their tolerance, one line each.
#[derive(Default)]
struct Report(String);

impl Report {
    fn compare(&mut self, what: std::fmt::Arguments<'_>, computed: &[f64], recorded: &[f64], tolerance: f64) {
        let scale = recorded.iter().fold(1.0f64, |s, x| s.max(x.abs()));
        let (_, difference) = worst(computed, recorded, scale);
        if difference > tolerance {
            let _ = writeln!(self.0, "{what}: {difference:.2e} > {tolerance:.0e}");
        }
    }

    fn finish(self) {
        assert!(self.0.is_empty(), "differences from MuJoCo 3.14.0:\n{}", self.0);
    }
}

/// Inertia tensors in the bodies' frames, because the order and the signs of principal axes are arbitrary.
fn tensors(inertia: &[f64], iquat: &[f64]) -> Vec<f64> {
    let mut all = Vec::new();
    for (i, q) in inertia.chunks(3).zip(iquat.chunks(4)) {
        let r = core::math::quat_to_mat([q[0], q[1], q[2], q[3]]);
        for a in 0..3 {
            for b in 0..3 {
                all.push((0..3).map(|k| r[3 * a + k] * i[k] * r[3 * b + k]).sum());
            }
        }
    }
    all
}

#[test]
fn models_compile_to_the_same_numbers() {
    let mut report = Report::default();
    for Case { name, .. } in CASES {
        let case = recording(name);
        let m = load(&case);
        let d = Data::new(&m);
        let get = |field: &str| list(&m, &d, reflect::field(Object::Model, field).unwrap());
        let compiled = case["compiled"].as_object().unwrap();
        for (field, values) in compiled {
            if !matches!(field.as_str(), "body_inertia" | "body_iquat") {
                report.compare(format_args!("{name}: {field}"), &get(field), &numbers(values), COMPILED);
            }
        }
        if let (Some(i), Some(q)) = (compiled.get("body_inertia"), compiled.get("body_iquat")) {
            let recorded = tensors(&numbers(i), &numbers(q));
            let computed = tensors(&get("body_inertia"), &get("body_iquat"));
            report.compare(format_args!("{name}: inertia"), &computed, &recorded, COMPILED);
        }
    }
    report.finish();
}

/// The recorded values of a contact: name and number of values.
const CONTACT: [(&str, usize); 12] = [
    ("geom1", 1),
    ("geom2", 1),
    ("dim", 1),
    ("exclude", 1),
    ("dist", 1),
    ("includemargin", 1),
    ("mu", 1),
    ("pos", 3),
    ("frame", 9),
    ("friction", 5),
    ("solref", 2),
    ("solimp", 5),
];

/// All values of a contact, in the order of the recording.
fn contact(c: &Contact) -> Vec<f64> {
    let counts = [c.geom1, c.geom2, c.dim, usize::from(c.exclude)].map(|n| n as f64);
    let numbers = counts.into_iter().chain([c.dist, c.includemargin, c.mu]);
    let arrays = c.pos.iter().chain(&c.frame).chain(&c.friction).chain(&c.solref).chain(&c.solimp);
    numbers.chain(arrays.copied()).collect()
}

/// Contacts sorted by geoms, then by position, because each side lists them in the order of its broad phase.
fn sorted(contacts: &[Contact]) -> Vec<Vec<f64>> {
    let mut rows: Vec<&Contact> = contacts.iter().collect();
    rows.sort_by_key(|c| (c.geom1, c.geom2, c.pos.map(|x| (x * 1e6).round() as i64)));
    rows.into_iter().map(contact).collect()
}

#[test]
fn every_field_after_a_forward_pass_is_the_same() {
    let mut report = Report::default();
    for Case { name, .. } in CASES {
        let case = recording(name);
        let mut m = load(&case);
        (
            *m.edit().opt.tolerance,
            *m.edit().opt.ls_tolerance,
            *m.edit().opt.iterations,
            *m.edit().opt.ls_iterations,
        ) = (0.0, 1e-10, 200, 100);
        let mut d = Data::new(&m);
        for (k, state) in case["forward"].as_array().unwrap().iter().enumerate() {
            start(&m, &mut d);
            for (field, values) in state["state"].as_object().unwrap() {
                let id = reflect::field(Object::Data, field).unwrap();
                for (i, x) in numbers(values).into_iter().enumerate() {
                    assert!(
                        labspec_core::view_mut(&mut m, &mut d, id).unwrap().set(i, x),
                        "{name}: {field}[{i}]"
                    );
                }
            }
            core::forward(&m, &mut d).unwrap();
            for (field, values) in state["data"].as_object().unwrap() {
                let computed = list(&m, &d, reflect::field(Object::Data, field).unwrap());
                report.compare(
                    format_args!("{name}, state {k}: {field}"),
                    &computed,
                    &numbers(values),
                    FORWARD,
                );
            }
            let what = format_args!("{name}, state {k}: M");
            report.compare(what, &core::full_m(&m, &d).unwrap(), &numbers(&state["M"]), FORWARD);
            let rows = state["nefc"].as_f64().unwrap();
            report.compare(format_args!("{name}, state {k}: nefc"), &[d.nefc as f64], &[rows], 0.0);
            let recorded: Vec<Vec<f64>> = state["contact"].as_array().unwrap().iter().map(numbers).collect();
            let computed = sorted(&d.contact);
            if computed.len() != recorded.len() {
                let _ = writeln!(
                    report.0,
                    "{name}, state {k}: {} contacts, not {}",
                    computed.len(),
                    recorded.len()
                );
            }
            for (i, (a, b)) in computed.iter().zip(&recorded).enumerate() {
                let mut at = 0;
                for (what, n) in CONTACT {
                    let range = at..at + n;
                    let what = format_args!("{name}, state {k}: contact[{i}].{what}");
                    report.compare(what, &a[range.clone()], &b[range], FORWARD);
                    at += n;
                }
            }
        }
    }
    report.finish();
}

/// The recorded count of every step, from its run lengths.
fn counts(recorded: &Value) -> Vec<usize> {
    let mut all = Vec::new();
    for run in recorded.as_array().unwrap() {
        let [count, repeats] = [0, 1].map(|i| run[i].as_u64().unwrap() as usize);
        all.extend(std::iter::repeat_n(count, repeats));
    }
    all
}

/// The position to which `record.py` moves the mocap body before a step.
fn move_mocap(m: &Model, d: &mut Data, step: usize) {
    if m.nmocap > 0 {
        let t = step as f64 * m.opt.timestep;
        d.edit().mocap_pos.copy_from_slice(&[0.05 * t, 0.0, 0.2 + 0.1 * t - 0.2 * t * t]);
    }
}

#[test]
fn trajectories_are_the_same() {
    let mut report = Report::default();
    for Case { name, trajectory } in CASES {
        let case = recording(name);
        let m = load(&case);
        let golden = &case["trajectory"];
        let [steps, every] = ["steps", "every"].map(|k| golden[k].as_u64().unwrap() as usize);
        let (ncon, nefc) = (counts(&golden["ncon"]), counts(&golden["nefc"]));
        let mut rows = golden["rows"].as_array().unwrap().iter();
        let mut d = Data::new(&m);
        start(&m, &mut d);
        let before = report.0.len();
        for i in 0..=steps {
            if i % every == 0 {
                let row = rows.next().unwrap();
                report.compare(format_args!("{name}: time"), &[d.time], &numbers(&row["time"]), 0.0);
                let what = format_args!("{name}, step {i}: qpos");
                report.compare(what, &d.qpos, &numbers(&row["qpos"]), *trajectory);
                let what = format_args!("{name}, step {i}: qvel");
                report.compare(what, &d.qvel, &numbers(&row["qvel"]), *trajectory);
            }
            if i < steps {
                move_mocap(&m, &mut d, i);
                core::step(&m, &mut d).unwrap();
                let (computed, recorded_counts) =
                    ([d.ncon as f64, d.nefc as f64], [ncon[i] as f64, nefc[i] as f64]);
                report.compare(
                    format_args!("{name}, step {i}: ncon, nefc"),
                    &computed,
                    &recorded_counts,
                    0.0,
                );
            }
            // Later differences follow from the first one.
            if report.0.len() > before {
                break;
            }
        }
        let raised: usize = d.warning.iter().map(|w| w.number).sum();
        let recorded: u64 = golden["warnings"].as_object().unwrap().values().filter_map(Value::as_u64).sum();
        assert_eq!(raised as u64, recorded, "{name}: warnings {:?}", Warning::ALL);
    }
    report.finish();
}
