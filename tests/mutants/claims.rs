//! Which mistakes in a lab or a quiz can be detected without a claim, and which need a claim of the author.
//!
//! A mistake can be detected without a claim if no author could reasonably have intended the resulting lab. It needs a claim if the
//! result is a correct lab that an author could have written on purpose. For kinds that contain both, a predicate decides by the
//! content of the lesson. It does not depend on whether the mistake was found.

use super::material::{Piece, PieceKind};
use super::student_view;
use labspec::bind::Programs;
use labspec::bind::dimensions;
use labspec::bind::scene::Models;
use labspec::lint::load_lesson;
use labspec::source::SourceFile;
use labspec_core::Obj;
use labspec_expr::dimension::Measure;
use serde_json::Value;

/// A mistake and its context.
pub(super) struct Case<'a> {
    pub(super) piece: &'a Piece,
    pub(super) json: &'a Value,
    pub(super) models: &'a Models,
}

/// What is needed to detect a mistake of a kind.
#[derive(Clone, Copy)]
pub(super) enum Needs {
    /// No claim is needed.
    Nothing,
    /// A claim is needed, for this reason.
    Claim(&'static str),
    /// No claim is needed if the predicate is true, otherwise a claim, for this reason.
    Some(fn(&Case<'_>) -> bool, &'static str),
}

/// Kinds of which all or some mistakes need a claim. Other kinds need none: no author intends a name that does not exist, a
/// plot that shows nothing, or a control without an effect.
const KINDS: [(&str, Needs); 23] = [
    (
        "next-index",
        Needs::Some(
            measures_another,
            "the neighbour has the same unit, and only the author knows which one is intended. It is recognizable if the unit differs, or if the element then appears twice",
        ),
    ),
    (
        "written-index",
        Needs::Some(
            written_twice,
            "writing the neighbour has an effect too. It is recognizable if one element is then stored twice in a row, or if the label quotes the element",
        ),
    ),
    (
        "wrong-sign",
        Needs::Some(
            never_negative,
            "the author chooses the positive direction. It is recognizable if the label names a quantity that is never negative: a time, a count, a kinetic energy, a normal force, a speed",
        ),
    ),
    (
        "frozen-trace",
        Needs::Some(
            called_by_name,
            "a constant beside curves may be an intended reference line. It is recognizable if it is the only curve of its plot, or has the name of an object in the model",
        ),
    ),
    (
        "early-stop",
        Needs::Some(
            shows_no_run,
            "without a plot, a lab of one step may be intended. It is recognizable if there is a plot, or if the step is longer than the run",
        ),
    ),
    (
        "no-digits",
        Needs::Some(
            has_equal_output,
            "printing a large value as an integer may be intended. It is recognizable if a changing value then prints at most two texts, or if a non-zero value prints 0",
        ),
    ),
    ("one-value-forgotten", Needs::Claim("a constant beside `value` may be intended")),
    ("dropped-statement", Needs::Claim("a control may set one thing and not the other")),
    (
        "reset-forgotten",
        Needs::Some(
            states_again,
            "a control may act in the middle of a run. It is recognizable if the note says that the run restarts, or if the control has an effect only after a restart",
        ),
    ),
    ("no-controller", Needs::Claim("a lab without its controller is a valid lab")),
    ("no-setup", Needs::Claim("a lab that starts from the initial state of its model is a valid lab")),
    ("no-key", Needs::Claim("a lab that starts from the initial state of its model is a valid lab")),
    (
        "long-step",
        Needs::Some(
            shown_otherwise,
            "the setup states the timestep, and there are labs about long timesteps. It is recognizable if a control shows another one",
        ),
    ),
    (
        "no-gravity",
        Needs::Some(
            shown_otherwise,
            "a lesson may be about weightlessness. It is recognizable if a control shows a gravity",
        ),
    ),
    ("key-shifted", Needs::Claim("the author states which option is right")),
    ("no-tolerance", Needs::Some(not_whole, "a question may ask for an exact integer")),
    (
        "ten-times",
        Needs::Some(
            explained,
            "the author states the answer. It is recognizable if the explanation states another number",
        ),
    ),
    ("answer-sign", Needs::Some(explained, "as above")),
    (
        "answer-digit",
        Needs::Some(
            explained,
            "as above; an answer within its tolerance of the number in the explanation is right",
        ),
    ),
    (
        "labels-exchanged",
        Needs::Some(
            labels_identify,
            "both have the same dimension, and neither label is a name in the model. It is recognizable if units or such names distinguish them",
        ),
    ),
    (
        "label-in-degrees",
        Needs::Some(
            known_measure,
            "a number in the text may have its own unit. It is recognizable if the text contains no such number",
        ),
    ),
    ("wrong-unit", Needs::Some(known_measure, "as above")),
    ("unused-element", Needs::Nothing),
];

/// What is needed to detect mistakes of a kind.
pub(super) fn needs(kind: &str) -> Needs {
    KINDS.iter().find(|(name, _)| *name == kind).map_or(Needs::Nothing, |(_, needs)| *needs)
}

/// Whether this mistake can be detected without a claim.
pub(super) fn is_measurable(kind: &str, case: &Case<'_>) -> bool {
    match needs(kind) {
        Needs::Nothing => true,
        Needs::Claim(_) => false,
        Needs::Some(which, _) => which(case),
    }
}

/// Whether the lesson makes a claim about the changed part.
pub(super) fn claimed(case: &Case<'_>) -> bool {
    let at = |json: &Value| json["questions"].as_array().cloned().unwrap_or_default();
    match case.piece.what {
        PieceKind::Lab => case.piece.home.is_some(),
        PieceKind::Quiz => {
            let (old, new) = (at(&case.piece.json), at(case.json));
            old.iter().zip(&new).any(|(a, b)| a != b && a["verify"].is_object())
        }
    }
}

/// The entries of a list whose texts under `key` differ between the original and the mutant, with their indices.
fn changed<'v>(a: &'v Value, b: &'v Value, list: &str, key: &str) -> Vec<(usize, &'v Value, &'v Value)> {
    let of = |v: &'v Value| v[list].as_array().map_or(&[][..], Vec::as_slice);
    of(a)
        .iter()
        .zip(of(b))
        .enumerate()
        .filter(|(_, (a, b))| a[key] != b[key])
        .map(|(i, (a, b))| (i, a, b))
        .collect()
}

/// Traces and readouts in the order of a lab's programs, each with the label of its plot.
fn displayed(lab: &Value) -> Vec<(&Value, &str)> {
    let list = |v: &'_ Value| v.as_array().map_or(0, Vec::len);
    let mut all = Vec::new();
    for p in 0..list(&lab["plots"]) {
        let plot = &lab["plots"][p];
        let label = plot["ylabel"].as_str().unwrap_or("");
        all.extend((0..list(&plot["traces"])).map(|t| (&plot["traces"][t], label)));
    }
    all.extend((0..list(&lab["readouts"])).map(|r| (&lab["readouts"][r], "")));
    all
}

/// The quantity that each trace and readout measures.
fn measures(json: &Value, models: &Models) -> Option<Vec<Measure>> {
    let lesson = load_lesson(SourceFile::new("piece.json", json.to_string()), models.folder());
    let lab = lesson.all_labs().into_iter().next()?;
    let model = models.model_of_lab(lab, &mut Vec::new())?;
    let programs = Programs::compile(lab, &model, &mut Vec::new());
    let found = dimensions(lab, &model, &programs).probes;
    Some(found.into_iter().map(|m| m.map_or(Measure::Unknown, |m| m.value)).collect())
}

/// The names of the model that labels may contain.
fn names(json: &Value, models: &Models) -> Vec<String> {
    let lesson = load_lesson(SourceFile::new("piece.json", json.to_string()), models.folder());
    let model =
        lesson.all_labs().into_iter().next().and_then(|lab| models.model_of_lab(lab, &mut Vec::new()));
    let kinds = [Obj::Body, Obj::Joint, Obj::Geom, Obj::Site, Obj::Actuator, Obj::Sensor];
    let of = |m: &labspec_core::Model| {
        kinds.iter().flat_map(|k| m.names.of_kind(*k).to_vec()).collect::<Vec<String>>()
    };
    model.map_or(Vec::new(), |m| of(&m))
}

/// A label without its unit, and the unit.
fn parted(label: &str) -> (&str, &str) {
    let cut = label.strip_suffix(')').and_then(|l| l.rsplit_once(" ("));
    cut.map_or((label, ""), |(l, unit)| (l, unit))
}

fn measures_another(case: &Case<'_>) -> bool {
    let (old, new) = (displayed(&case.piece.json), displayed(case.json));
    let Some(i) = old.iter().zip(&new).position(|(a, b)| a.0["expr"] != b.0["expr"]) else { return false };
    let ((one, axis), text) = (old[i], new[i].0["expr"].as_str().unwrap_or(""));
    let inside = text.split_once("hypot(").map_or("", |(_, t)| t.split(')').next().unwrap_or(""));
    let args: Vec<&str> = inside.split(", ").collect();
    let twice = args.iter().enumerate().any(|(i, a)| !a.is_empty() && args[..i].contains(a));
    let has_unit = !parted(one["label"].as_str().unwrap_or("")).1.is_empty() || !parted(axis).1.is_empty();
    let of = |json| measures(json, case.models).and_then(|all| all.get(i).copied());
    let differ = match (of(&case.piece.json), of(case.json)) {
        (Some(Measure::Dimension(a)), Some(Measure::Dimension(b))) => !a.agrees(&b),
        // An expression with an invalid index has no measure.
        (Some(_), None) => true,
        _ => false,
    };
    twice || has_unit && differ
}

fn written_twice(case: &Case<'_>) -> bool {
    let (old, new) = (&case.piece.json, case.json);
    let mut texts: Vec<(&str, &str)> = Vec::new();
    for key in ["setup", "controller"] {
        texts.extend((old[key] != new[key]).then(|| ("", new[key].as_str().unwrap_or(""))));
    }
    for key in ["set", "apply", "run"] {
        let all = changed(old, new, "controls", key);
        texts.extend(
            all.into_iter()
                .map(|(_, _, b)| (b["label"].as_str().unwrap_or(""), b[key].as_str().unwrap_or(""))),
        );
    }
    texts.iter().any(|(label, text)| {
        let targets: Vec<&str> =
            text.split(';').map(|s| s.split(" = ").next().unwrap_or("").trim()).collect();
        let same =
            |a: &str, b: &str| a.ends_with(']') && b.ends_with(']') && (a.ends_with(b) || b.ends_with(a));
        let twice = targets.windows(2).any(|w| same(w[0], w[1]));
        twice || label.contains('[')
    })
}

fn never_negative(case: &Case<'_>) -> bool {
    let words = [
        "time (",
        "time since",
        "contacts",
        "constraint rows",
        "kinetic energy",
        "normal force",
        "nq",
        "nv",
        "|",
    ];
    let (old, new) = (displayed(&case.piece.json), displayed(case.json));
    let it = old.iter().zip(&new).find(|(a, b)| a.0["expr"] != b.0["expr"]);
    it.is_some_and(|((one, _), _)| {
        let [label, text] = ["label", "expr"].map(|k| one[k].as_str().unwrap_or(""));
        words.iter().any(|w| label.starts_with(w)) || label.starts_with("speed") && text.contains("hypot")
    })
}

fn called_by_name(case: &Case<'_>) -> bool {
    let names = names(&case.piece.json, case.models);
    let plots = |json: &Value| json["plots"].as_array().cloned().unwrap_or_default();
    plots(&case.piece.json).iter().zip(plots(case.json)).any(|(old, new)| {
        let it = changed(old, &new, "traces", "expr");
        let alone = old["traces"].as_array().is_some_and(|t| t.len() == 1);
        it.iter()
            .any(|(_, a, _)| alone || names.iter().any(|n| n == parted(a["label"].as_str().unwrap_or("")).0))
    })
}

fn shows_no_run(case: &Case<'_>) -> bool {
    let stop = case.json["stopAt"].as_f64().unwrap_or(0.0);
    let plots = case.json["plots"].as_array().is_some_and(|p| !p.is_empty());
    let lesson = load_lesson(SourceFile::new("piece.json", case.json.to_string()), case.models.folder());
    let model =
        lesson.all_labs().into_iter().next().and_then(|lab| case.models.model_of_lab(lab, &mut Vec::new()));
    plots || model.is_some_and(|m| stop < m.opt.timestep)
}

fn has_equal_output(case: &Case<'_>) -> bool {
    changed(&case.piece.json, case.json, "readouts", "digits").iter().any(|(i, _, _)| {
        let [before, now] =
            [&case.piece.json, case.json].map(|json| student_view::prints(json, case.models, *i));
        let zero = |t: &String| t.parse::<f64>() == Ok(0.0);
        now.len() <= 2 && before.len() >= 10 || now.iter().all(zero) && !before.iter().any(zero)
    })
}

fn states_again(case: &Case<'_>) -> bool {
    let note = case.json["note"].as_str().unwrap_or("").to_lowercase();
    let it = changed(&case.piece.json, case.json, "controls", "reset");
    let named = it.iter().any(|(_, a, _)| {
        let label = a["label"].as_str().unwrap_or("").to_lowercase();
        note.split(['.', ';']).any(|s| {
            let again =
                ["again", "restarts", "resets the"].iter().any(|w| s.contains(w)) && !s.contains("button");
            again && (s.contains("slider") || label.split(' ').next().is_some_and(|w| s.contains(w)))
        })
    });
    let only = |json: &Value| json["setup"].as_str().is_some_and(|s| s.contains("ctx."));
    named || it.iter().any(|(_, a, _)| a["param"].is_string()) && only(case.json)
}

fn shown_otherwise(case: &Case<'_>) -> bool {
    let setup = case.json["setup"].as_str().unwrap_or("").rsplit("; ").next().unwrap_or("");
    let field = setup.split([' ', '.']).find(|w| ["timestep", "gravity"].contains(w)).unwrap_or("-");
    let controls = case.json["controls"].as_array();
    controls
        .into_iter()
        .flatten()
        .any(|c| ["set", "apply"].iter().any(|k| c[k].as_str().is_some_and(|t| t.contains(field))))
}

fn question<'c>(case: &'c Case<'_>, key: &str) -> Option<&'c Value> {
    changed(&case.piece.json, case.json, "questions", key).first().map(|(_, a, _)| *a)
}

fn not_whole(case: &Case<'_>) -> bool {
    question(case, "tol").and_then(|q| q["answer"].as_f64()).is_some_and(|a| a.fract() != 0.0)
}

fn explained(case: &Case<'_>) -> bool {
    let Some((_, old, new)) = changed(&case.piece.json, case.json, "questions", "answer").first().copied()
    else {
        return false;
    };
    let [a, b] = [old, new].map(|q| q["answer"].as_f64().unwrap_or(0.0));
    let tolerance = old["tol"].as_f64().unwrap_or(0.02 * a.abs());
    let text = old["explain"].as_str().unwrap_or("");
    let number = a.to_string();
    let says = text.match_indices(&number).any(|(at, _)| {
        let digit = |c: Option<char>| c.is_some_and(|c| c.is_ascii_digit());
        !digit(text[..at].chars().next_back()) && !digit(text[at + number.len()..].chars().next())
    });
    says && (a - b).abs() > tolerance
}

fn labels_identify(case: &Case<'_>) -> bool {
    let names = names(&case.piece.json, case.models);
    let (old, new) = (displayed(&case.piece.json), displayed(case.json));
    let both: Vec<&str> = old
        .iter()
        .zip(&new)
        .filter(|(a, b)| a.0["label"] != b.0["label"])
        .filter_map(|(a, _)| a.0["label"].as_str())
        .collect();
    let units: Vec<&str> = both.iter().map(|l| parted(l).1).collect();
    let sizes = both.iter().all(|l| ["nq", "nv"].contains(l));
    sizes
        || units.windows(2).any(|w| w[0] != w[1])
        || both.iter().all(|l| names.iter().any(|n| n == parted(l).0))
}

fn known_measure(case: &Case<'_>) -> bool {
    let (old, new) = (displayed(&case.piece.json), displayed(case.json));
    let at = old.iter().zip(&new).position(|(a, b)| a != b);
    let all = measures(case.json, case.models).unwrap_or_default();
    at.is_some_and(|i| matches!(all.get(i), Some(Measure::Dimension(d)) if d.is_exact()))
}
