//! What a student sees of a lab or a quiz: its texts, and what it displays while it runs, also after a control was
//! moved and after a reset.

use super::material::{Piece, PieceKind};
use labspec::bind::Programs;
use labspec::bind::scene::Models;
use labspec::lint::load_lesson;
use labspec::run::{self, Cell, Play, Session, Start};
use labspec::source::SourceFile;
use labspec::spec::{ControlKind, Lab};
use labspec_core::{Model, Plan};
use labspec_expr::Value as Chosen;
use serde_json::Value;
use std::fmt::Write;
use std::ops::ControlFlow;

/// The numbers of steps: of the unchanged lab, before a control is moved, after that, and after the reset.
const STEPS: [usize; 4] = [260, 20, 80, 40];
/// The number of steps between samples.
const EVERY: usize = 20;

/// Keys that contain code, which a student does not see.
const CODE: [&str; 13] = [
    "model",
    "xml",
    "key",
    "setup",
    "controller",
    "set",
    "apply",
    "param",
    "run",
    "expr",
    "init",
    "reset",
    "verify",
];

/// Runs every stage in every step, because stages that no program needs are drawn as well.
fn start_with_every_stage<'p>(lab: &Lab, model: &Model, programs: &'p Programs) -> Session<'p> {
    let start = Start { plan: Some(Plan::full()), ..Start::of_lab(lab) };
    Session::start(programs, model, start)
}

/// Everything that a student can see, as a text.
pub(crate) fn visible_text(piece: &Piece, json: &Value, models: &Models) -> String {
    let mut visible = json.clone();
    if piece.what == PieceKind::Quiz {
        // The labs of its questions are separate pieces.
        return visible.to_string();
    }
    remove_code(&mut visible);
    let mut text = visible.to_string();
    let lesson = load_lesson(SourceFile::new("piece.json", json.to_string()), models.folder());
    let Some(lab) = lesson.all_labs().into_iter().next() else { return text };
    let Some(model) = models.model_of_lab(lab, &mut Vec::new()) else { return text };
    let programs = Programs::compile(lab, &model, &mut Vec::new());
    let start = || start_with_every_stage(lab, &model, &programs);
    let [whole, before, after, again] = STEPS;
    let mut session = start();
    play(&mut session, lab, whole, &mut text);
    for (i, control) in lab.controls.iter().enumerate() {
        let mut session = start();
        play(&mut session, lab, before, &mut text);
        match &control.kind {
            ControlKind::Slider { max, .. } => session.set_control(i, Chosen::Number(max.value)),
            ControlKind::Select { options, .. } => {
                let last = options.last().map(|o| match &o.value {
                    labspec::json::Scalar::Number(n) => Chosen::Number(n.value),
                    labspec::json::Scalar::Text(t) => Chosen::String(t.value.as_str().into()),
                    labspec::json::Scalar::Bool(b, _) => Chosen::Boolean(*b),
                });
                session.set_control(i, last.unwrap_or(Chosen::Undefined));
            }
            ControlKind::Button { .. } => session.press(i),
        }
        play(&mut session, lab, after, &mut text);
        session.reset();
        play(&mut session, lab, again, &mut text);
    }
    text
}

/// Removes the code from a lab.
fn remove_code(json: &mut Value) {
    match json {
        Value::Object(map) => {
            CODE.iter().for_each(|key| drop(map.shift_remove(*key)));
            // The digits are visible in the runs, where the readouts are printed.
            let readouts = map.get_mut("readouts").and_then(Value::as_array_mut);
            for readout in readouts.into_iter().flatten().filter_map(Value::as_object_mut) {
                readout.shift_remove("digits");
            }
            map.values_mut().for_each(remove_code);
        }
        Value::Array(list) => list.iter_mut().for_each(remove_code),
        _ => {}
    }
}

/// Writes what is displayed in this many steps: readouts as printed, traces and positions rounded to six digits.
fn play(session: &mut Session<'_>, lab: &Lab, steps: usize, text: &mut String) {
    let traces = lab.traces().count();
    run::play(session, &Play { every: EVERY, ..Play::steps(steps) }, |session, _| {
        for (i, cell) in session.sample().into_iter().enumerate() {
            let readout = i.checked_sub(1 + traces).and_then(|i| lab.readouts.get(i));
            match (readout, &cell) {
                (Some(readout), cell) => write!(text, " {}", cell.rounded(readout.digits())).unwrap(),
                (None, Cell::Number(x)) => write!(text, " {}", rounded(*x)).unwrap(),
                (None, cell) => write!(text, " {}", cell.rounded(6)).unwrap(),
            }
        }
        for x in &session.world.data.fields().geom_xpos {
            write!(text, " {}", rounded(*x)).unwrap();
        }
        text.push('\n');
        ControlFlow::Continue(())
    });
    writeln!(text, "{:?} {:?}", session.ended(), session.warnings.map(|w| w.number > 0)).unwrap();
}

/// Six significant digits; values below 1e-9 become 0.
fn rounded(x: f64) -> String {
    if x.abs() < 1e-9 { "0".into() } else { format!("{x:.5e}") }
}

/// The texts that a readout prints in short runs of the unchanged lab and with every control moved.
pub(super) fn prints(json: &Value, models: &Models, readout: usize) -> std::collections::BTreeSet<String> {
    let mut all = std::collections::BTreeSet::new();
    let lesson = load_lesson(SourceFile::new("piece.json", json.to_string()), models.folder());
    let Some(lab) = lesson.all_labs().into_iter().next() else { return all };
    let Some(model) = models.model_of_lab(lab, &mut Vec::new()) else { return all };
    let programs = Programs::compile(lab, &model, &mut Vec::new());
    let column = 1 + lab.traces().count() + readout;
    for moved in std::iter::once(None).chain((0..lab.controls.len()).map(Some)) {
        let mut session = start_with_every_stage(lab, &model, &programs);
        match moved.and_then(|i| Some((i, &lab.controls.get(i)?.kind))) {
            Some((i, ControlKind::Slider { max, .. })) => session.set_control(i, Chosen::Number(max.value)),
            Some((i, ControlKind::Button { .. })) => session.press(i),
            Some((i, ControlKind::Select { options, .. })) => {
                let last = options.last().and_then(|o| o.value.number());
                session.set_control(i, last.map_or(Chosen::Undefined, Chosen::Number));
            }
            None => {}
        }
        run::play(&mut session, &Play { every: EVERY, ..Play::steps(STEPS[0]) }, |session, _| {
            let digits = lab.readouts.get(readout).map_or(3, |r| r.digits());
            let cell = session.sample().into_iter().nth(column);
            all.extend(cell.map(|c| c.rounded(digits).trim_start_matches('-').to_string()));
            ControlFlow::Continue(())
        });
    }
    all
}
