//! Controls without a visible effect, over all of their range or over a part of it.
//!
//! The displays of two runs are compared bit for bit, so a small effect counts. Two controls may have an effect only together: each
//! is tested with the others moved, too, early and in mid-run. If the work budget ends before all tests are done, nothing is
//! reported.

use super::{IDLE_RANGE, needs_reset};
use crate::bind::ControlProgram;
use crate::check::observations::{
    Move, ObservationBench, ObservationHash, ObservedLab, Setting, longest_equal, settings, values,
};
use crate::check::setconst::digits;
use crate::spec::{Control, ControlKind};
use labspec_core::reflect::{FieldId, Object};
use labspec_expr::Value;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A control changes nothing that a student can see.
pub const IDLE_CONTROL: &Rule = &Rule {
    code: "idle-control",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "a control changes nothing that a student can see",
    why: "a student moves it, and every curve, number and position stays exactly the same: often the index is wrong, nothing reads the field, or something overwrites the value. The rule tries several values, early and late, with every other control moved too",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "controls": [{"label": "⟦friction⟧", "set": "model.geom_friction[2]", "min": 0.1, "max": 1, "value": 0.5}], "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "controls": [{"label": "gravity", "set": "model.opt.gravity[2]", "min": -20, "max": 0, "value": -10}], "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]}"#,
    ),
};

/// The number of steps of the runs that search for an idle part of a range.
const SHORT_RUN: usize = 250;
/// The number of adjacent values with equal results from which a part of a range counts as idle.
const MIN_EQUAL: usize = 3;
/// The time at which a button is pressed, as a fraction of the run.
const PRESS_TIME: f64 = 0.02;
/// Prefixes of fields of the model that only affect rendering; not all of them are compared.
const APPEARANCE_PREFIXES: [&str; 7] = ["light_", "mat_", "tex_", "cam_", "vis", "skin_", "geom_group"];

/// The number of presses of one button in a run.
const PRESSES: usize = 3;

/// Options that select a numerical method, not the physics.
const NUMERICS: [&str; 8] =
    ["integrator", "cone", "jacobian", "solver", "iterations", "tolerance", "impratio", "flags"];

pub(crate) fn check_idle_controls(observed: &mut ObservedLab<'_>, findings: &mut Vec<Finding>) {
    let ready = observed.bench.ready;
    let Some((steps, _)) = observed.bench.steps(observed.length).filter(|(n, _)| *n > 0) else { return };
    for (index, control) in ready.lab.controls.iter().enumerate() {
        let values = values(control);
        if values.is_empty() || observed.reported.contains(&index) || !judged(observed, index) {
            continue;
        }
        let moved: Vec<ObservationHash> = observed
            .records
            .iter()
            .filter(|r| r.moved.as_ref().is_some_and(|m| m.0 == index))
            .map(|r| r.hash)
            .collect();
        // Each value was set, and everything recomputed: this alone may change the result of the nominal run.
        let all_same = moved.windows(2).all(|pair| matches!(pair, [a, b] if a == b));
        let group = match &control.kind {
            ControlKind::Select { .. } if !all_same || values.len() < 2 => continue,
            ControlKind::Button { .. } | ControlKind::Select { .. } => 0..values.len(),
            ControlKind::Slider { .. } => {
                match longest_equal_range(&mut observed.bench, index, &values, steps.min(SHORT_RUN)) {
                    Some(group) => group,
                    None => continue,
                }
            }
        };
        let whole = group.len() == values.len();
        if whole && !all_same {
            continue;
        }
        let part = values.get(group).unwrap_or_default().to_vec();
        let before = observed.bench.runs;
        if idle(&mut observed.bench, index, &part, steps) {
            findings.push(finding(observed, control, index, &part, whole, before));
        }
    }
}

/// Whether this control should change a compared value, and no other rule reports it.
fn judged(observed: &ObservedLab<'_>, index: usize) -> bool {
    let ready = observed.bench.ready;
    let Some((_, program)) = ready.programs.controls.get(index) else { return false };
    let (run, param) = match program {
        ControlProgram::Press(run) => (run.as_ref(), None),
        ControlProgram::Change(_, action) => (action.run.as_ref(), action.param),
    };
    let read = |slot: u32| {
        ready.programs.bound().any(|b| {
            let e = b.program.effects();
            e.any_ctx || e.calls_values || e.ctx_reads.contains(&slot)
        })
    };
    let Some(bound) = run else { return param.is_some_and(read) };
    let effects = bound.program.effects();
    let drawn = effects.writes.iter().filter_map(|a| FieldId::new(a.field.0 as usize)).any(|f| {
        let name = f.info().name;
        f.info().object != Object::Data
            && (name.contains("rgba") || APPEARANCE_PREFIXES.iter().any(|l| name.starts_with(l)))
    });
    // Agreement of numerical methods is often the lesson.
    let numerics = !effects.writes.is_empty()
        && effects.writes.iter().all(|a| {
            FieldId::new(a.field.0 as usize)
                .is_some_and(|f| NUMERICS.iter().any(|n| f.info().name.ends_with(n)))
        });
    let plays = effects
        .calls
        .iter()
        .filter_map(|f| crate::bind::functions::name(*f))
        .any(|n| matches!(n, "play" | "pause"));
    let used = effects.uses_value || matches!(program, ControlProgram::Press(_)) || param.is_some();
    !drawn && !numerics && !plays && used && !effects.calls_values
}

/// The longest range of adjacent values that give equal results in short runs.
fn longest_equal_range(
    bench: &mut ObservationBench<'_>,
    index: usize,
    values: &[Option<Value>],
    steps: usize,
) -> Option<std::ops::Range<usize>> {
    let mut marks = Vec::new();
    for value in values {
        marks.push(bench.run(&[Move { step: 0, control: index, value: value.clone() }], steps)?.hash);
    }
    let best = longest_equal(&marks);
    (best.len() >= MIN_EQUAL.min(values.len())).then_some(best)
}

/// A slider is moved once. A button is pressed several times, because only the second press may have an effect. The number of
/// presses is odd, so that a toggle ends in the on state.
fn presses(nominal: &Move, steps: usize) -> Vec<Move> {
    let times = if nominal.value.is_none() { PRESSES } else { 1 };
    let interval = (steps.saturating_sub(nominal.step) / (2 * PRESSES)).max(1);
    (0..times)
        .map(|n| Move { step: nominal.step + n * interval, ..nominal.clone() })
        .filter(|m| m.step <= steps)
        .collect()
}

/// Whether all of these values of a control give the same result, for any other moves.
fn idle(bench: &mut ObservationBench<'_>, index: usize, values: &[Option<Value>], steps: usize) -> bool {
    let pick = match values.len() {
        n if n > 3 => vec![0, n / 2, n - 1],
        n => (0..n).collect(),
    };
    let picked: Vec<Option<Value>> = pick.into_iter().filter_map(|i| values.get(i).cloned()).collect();
    let press = ((PRESS_TIME * steps as f64) as usize).max(1);
    let lab = bench.ready.lab;
    for setting in settings(lab, index, press) {
        for step in [0, steps / 2] {
            let late = step > 0;
            // Late in the run, a slider moves from the first of the values.
            let mut seen: Option<ObservationHash> = None;
            for value in &picked {
                let tried_move = Move {
                    step: if value.is_none() { step.max(press + 1) } else { step },
                    control: index,
                    value: value.clone(),
                };
                let mut moves: Setting = Vec::new();
                if late && value.is_some() {
                    moves.push(Move { step: 0, control: index, value: picked.first().cloned().flatten() });
                }
                moves.extend(setting.iter().filter(|m| m.step == 0).cloned());
                moves.extend(presses(&tried_move, steps));
                moves.extend(setting.iter().filter(|m| m.step > 0).cloned());
                let Some(record) = bench.run(&moves, steps) else { return false };
                if seen.is_some_and(|hash| hash != record.hash) {
                    return false;
                }
                seen = Some(record.hash);
            }
            if picked.iter().any(Option::is_none) {
                // A button is compared with a run in which everything is only recomputed.
                let mut moves = setting.clone();
                moves.extend(presses(&Move::nothing(step.max(press + 1)), steps));
                let Some(record) = bench.run(&moves, steps) else { return false };
                if seen != Some(record.hash) {
                    return false;
                }
            }
        }
    }
    true
}

fn finding(
    observed: &ObservedLab<'_>,
    control: &Control,
    index: usize,
    part: &[Option<Value>],
    whole: bool,
    before: usize,
) -> Finding {
    let label = &control.label.value;
    let values: Vec<String> = part.iter().flatten().map(Value::to_string).collect();
    let values_text = match values.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("at {} and {last}", rest.join(", ")),
        _ => "pressed or not".into(),
    };
    let others =
        if observed.bench.ready.lab.controls.len() > 1 { ", with every other control moved too" } else { "" };
    let why = format!(
        "{values_text}, before the run and in the middle of it{others} ({} runs of {} s): every curve, number and position is the same to the last bit",
        observed.bench.runs - before,
        digits(observed.length, 3)
    );
    if let Some(finding) = needs_reset::check_setup(observed, control, index, &why).filter(|_| whole) {
        return finding;
    }
    let help = match first_written(observed, index) {
        Some(what) => format!(
            "check {what}, which it sets: whether it is the right one, what uses it, and what overwrites it"
        ),
        None => "check what reads the stored value, and what overwrites it".into(),
    };
    let (rule, message) = match (whole, values.first(), values.last()) {
        (false, Some(low), Some(high)) => {
            (IDLE_RANGE, format!("from {low} to {high}, \"{label}\" changes nothing visible"))
        }
        _ => (IDLE_CONTROL, format!("\"{label}\" changes nothing visible")),
    };
    Finding::warning(rule, control.label.span(), message).why(why).help(help)
}

/// The first field or variable that a control sets.
fn first_written(observed: &ObservedLab<'_>, index: usize) -> Option<String> {
    let (_, program) = observed.bench.ready.programs.controls.get(index)?;
    let bound = match program {
        ControlProgram::Press(run) => run.as_ref()?,
        ControlProgram::Change(_, action) => action.run.as_ref()?,
    };
    let access = *bound.program.own_writes().first()?;
    let info = FieldId::new(access.field.0 as usize)?.info();
    let object = match info.object {
        Object::Data => "data.",
        Object::Model => "model.",
        _ => "model.opt.",
    };
    let one = access.count == Some(1);
    Some(if one {
        format!("`{object}{}[{}]`", info.name, access.first)
    } else {
        format!("`{object}{}`", info.name)
    })
}
