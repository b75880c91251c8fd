//! Controls that change nothing anybody sees: over all of their range, or over a part of it.
//!
//! What two runs show is compared to the last bit, so what matters only a little matters. Two controls may act together only: each is
//! tried with the others moved, too, early and in mid-run. Where the work for that is spent before all is tried, nothing is said.

use super::ObservedLab;
use super::bench::{Move, ObservationBench};
use super::record::Mark;
use crate::bind::{ControlProgram, scalar};
use crate::finding::Finding;
use crate::rules;
use crate::spec::{Control, ControlKind, Lab};
use labspec_core::reflect::{FieldId, Object};
use labspec_expr::Value;

/// Steps of the runs that look for a part of a range that may be idle.
const QUICK: usize = 250;
/// Where on its range a slider is tried.
const PLACES: [f64; 5] = [0.0, 0.24, 0.5, 0.77, 1.0];
/// So many places in a row that look the same may be idle.
const IN_A_ROW: usize = 3;
/// Most options that are tried.
const MOST_OPTIONS: usize = 8;
/// When a button is pressed, as a share of the run.
const PRESS: f64 = 0.02;
/// Fields of the model that are drawn and do nothing else; not all of them are compared.
const LOOKS: [&str; 7] = ["light_", "mat_", "tex_", "cam_", "vis", "skin_", "geom_group"];

/// Presses of one button in a run.
const PRESSES: usize = 3;

/// Options that say how something is computed, and not what.
const NUMERICS: [&str; 8] =
    ["integrator", "cone", "jacobian", "solver", "iterations", "tolerance", "impratio", "flags"];

/// Something that is done to the other controls.
pub(super) type Setting = Vec<Move>;

pub(super) fn check_idle_controls(observed: &mut ObservedLab<'_>, findings: &mut Vec<Finding>) {
    let ready = observed.bench.ready;
    let Some((steps, _)) = observed.bench.steps(observed.length).filter(|(n, _)| *n > 0) else { return };
    for (index, control) in ready.lab.controls.iter().enumerate() {
        let values = values(control);
        if values.is_empty() || observed.reported.contains(&index) || !judged(observed, index) {
            continue;
        }
        let moved: Vec<Mark> = observed
            .records
            .iter()
            .filter(|r| r.moved.as_ref().is_some_and(|m| m.0 == index))
            .map(|r| r.mark)
            .collect();
        // Each was set, and everything computed anew: what the run as it stands shows may differ by that alone.
        let all_same = moved.windows(2).all(|pair| matches!(pair, [a, b] if a == b));
        let group = match &control.kind {
            ControlKind::Select { .. } if !all_same || values.len() < 2 => continue,
            ControlKind::Button { .. } | ControlKind::Select { .. } => 0..values.len(),
            ControlKind::Slider { .. } => {
                match suspicious(&mut observed.bench, index, &values, steps.min(QUICK)) {
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

/// Whether this control is meant to change something that is compared, and is not told by another rule.
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
            && (name.contains("rgba") || LOOKS.iter().any(|l| name.starts_with(l)))
    });
    // That ways of computing agree is often the lesson.
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

/// The values that a control is tried at, in order; a button has none.
pub(super) fn values(control: &Control) -> Vec<Option<Value>> {
    match &control.kind {
        // What cannot be moved is another rule's.
        ControlKind::Slider { min, max, .. } if min.value >= max.value => Vec::new(),
        ControlKind::Slider { min, max, .. } => {
            let step = control.step().filter(|s| *s > 0.0).unwrap_or(f64::NAN);
            let on_grid = |share: f64| {
                let x = min.value + (share * (max.value - min.value) / step).round() * step;
                let tidy = format!("{x:.12e}").parse().unwrap_or(x);
                if x.is_finite() { f64::max(min.value, f64::min(tidy, max.value)) } else { min.value }
            };
            let mut all: Vec<f64> = PLACES.iter().map(|s| on_grid(*s)).collect();
            if let Some(last) = all.last_mut() {
                *last = max.value;
            }
            all.dedup();
            all.into_iter().map(|x| Some(Value::Number(x))).collect()
        }
        ControlKind::Select { options, .. } => {
            options.iter().take(MOST_OPTIONS).map(|o| Some(scalar(&o.value))).collect()
        }
        ControlKind::Button { .. } => vec![None],
    }
}

/// Places in a row that look the same in short runs: the longest such row.
fn suspicious(
    bench: &mut ObservationBench<'_>,
    index: usize,
    values: &[Option<Value>],
    steps: usize,
) -> Option<std::ops::Range<usize>> {
    let mut marks = Vec::new();
    for value in values {
        marks.push(bench.run(&[Move { step: 0, control: index, value: value.clone() }], steps)?.mark);
    }
    let mut best = 0..0;
    let mut start = 0;
    for i in 1..=marks.len() {
        if marks.get(i) != marks.get(start) {
            if i - start > best.len() {
                best = start..i;
            }
            start = i;
        }
    }
    (best.len() >= IN_A_ROW.min(values.len())).then_some(best)
}

/// A slider is moved once. A button is pressed several times, as it may be the second press that acts; an odd number of times, so
/// that what it switches on is on.
fn presses(nominal: &Move, steps: usize) -> Vec<Move> {
    let times = if nominal.value.is_none() { PRESSES } else { 1 };
    let apart = (steps.saturating_sub(nominal.step) / (2 * PRESSES)).max(1);
    (0..times)
        .map(|n| Move { step: nominal.step + n * apart, ..nominal.clone() })
        .filter(|m| m.step <= steps)
        .collect()
}

/// Whether it makes no difference which of these values a control has, whatever else is done.
fn idle(bench: &mut ObservationBench<'_>, index: usize, values: &[Option<Value>], steps: usize) -> bool {
    let pick = match values.len() {
        n if n > 3 => vec![0, n / 2, n - 1],
        n => (0..n).collect(),
    };
    let picked: Vec<Option<Value>> = pick.into_iter().filter_map(|i| values.get(i).cloned()).collect();
    let press = ((PRESS * steps as f64) as usize).max(1);
    let lab = bench.ready.lab;
    for setting in settings(lab, index, press) {
        for at in [0, steps / 2] {
            let late = at > 0;
            // Late, a slider comes from the first of the values.
            let mut seen: Option<Mark> = None;
            for value in &picked {
                let tried_move = Move {
                    step: if value.is_none() { at.max(press + 1) } else { at },
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
                if seen.is_some_and(|mark| mark != record.mark) {
                    return false;
                }
                seen = Some(record.mark);
            }
            if picked.iter().any(Option::is_none) {
                // A button: against the run in which everything is only computed anew.
                let mut moves = setting.clone();
                moves.extend(presses(&Move::nothing(at.max(press + 1)), steps));
                let Some(record) = bench.run(&moves, steps) else { return false };
                if seen != Some(record.mark) {
                    return false;
                }
            }
        }
    }
    true
}

/// What is done to the other controls: nothing, each button, all of them at their ends, both together, each alone.
pub(super) fn settings(lab: &Lab, nominal: usize, press: usize) -> Vec<Setting> {
    let others = || lab.controls.iter().enumerate().filter(move |(i, _)| *i != nominal);
    let ends: Vec<(usize, Vec<Value>)> = others()
        .filter_map(|(i, c)| match &c.kind {
            ControlKind::Slider { min, max, .. } => {
                Some((i, vec![Value::Number(max.value), Value::Number(min.value)]))
            }
            ControlKind::Select { options, .. } => {
                Some((i, options.iter().rev().take(MOST_OPTIONS).map(|o| scalar(&o.value)).collect()))
            }
            ControlKind::Button { .. } => None,
        })
        .collect();
    let buttons: Vec<Setting> = others()
        .filter(|(_, c)| matches!(c.kind, ControlKind::Button { .. }))
        .map(|(i, _)| vec![Move { step: press, control: i, value: None }])
        .collect();
    let set = |control: usize, value: &Value| Move { step: 0, control, value: Some(value.clone()) };
    let together = |which: fn(&[Value]) -> Option<&Value>| -> Setting {
        ends.iter().filter_map(|(i, list)| Some(set(*i, which(list)?))).collect()
    };
    let mut all: Vec<Setting> = vec![Vec::new()];
    all.extend(buttons.iter().cloned());
    let corners = [together(<[Value]>::first), together(<[Value]>::last)];
    let alone = ends.iter().flat_map(|(i, list)| list.iter().map(|v| vec![set(*i, v)]));
    let more: Vec<Setting> = corners.into_iter().chain(alone).filter(|s| !s.is_empty()).collect();
    all.extend(more.iter().cloned());
    all.extend(buttons.iter().flat_map(|b| more.iter().map(|s| [s.clone(), b.clone()].concat())));
    let mut once: Vec<Setting> = Vec::new();
    for setting in all {
        if !once.contains(&setting) {
            once.push(setting);
        }
    }
    once
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
    let at = match values.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("at {} and {last}", rest.join(", ")),
        _ => "pressed or not".into(),
    };
    let others =
        if observed.bench.ready.lab.controls.len() > 1 { ", with every other control moved too" } else { "" };
    let why = format!(
        "{at}, before the run and in the middle of it{others} ({} runs of {} s): every curve, number and position is the same to the last bit",
        observed.bench.runs - before,
        crate::check::setconst::digits(observed.length, 3)
    );
    if let Some(slot) = for_the_setup(observed, index).filter(|_| whole) {
        return Finding::warning(
            rules::NEEDS_RESET,
            control.label.span(),
            format!("\"{label}\" takes effect only after a reset"),
        )
        .why(format!("only the setup reads {slot}, and the setup runs only at a reset. {why}"))
        .help("add \"reset\": true");
    }
    let help = match written(observed, index) {
        Some(what) => format!(
            "check {what}, which it sets: whether it is the right one, what uses it, and what overwrites it"
        ),
        None => "check what reads the stored value, and what overwrites it".into(),
    };
    let (rule, message) = match (whole, values.first(), values.last()) {
        (false, Some(low), Some(high)) => {
            (rules::IDLE_RANGE, format!("from {low} to {high}, \"{label}\" changes nothing visible"))
        }
        _ => (rules::IDLE_CONTROL, format!("\"{label}\" changes nothing visible")),
    };
    Finding::warning(rule, control.label.span(), message).why(why).help(help)
}

/// The first thing that a control sets.
fn written(observed: &ObservedLab<'_>, index: usize) -> Option<String> {
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

/// What a control stores, where the setup reads it and nothing else does, in words.
fn for_the_setup(observed: &ObservedLab<'_>, index: usize) -> Option<String> {
    let programs = &observed.bench.ready.programs;
    let (_, ControlProgram::Change(_, action)) = programs.controls.get(index)? else { return None };
    let stored = action.run.as_ref().map(|b| b.program.effects().ctx_writes.clone()).unwrap_or_default();
    let slots: Vec<u32> = stored.into_iter().chain(action.param).collect();
    let reads = |effects: &labspec_expr::Effects| slots.iter().any(|s| effects.ctx_reads.contains(s));
    let setup = programs.setup.as_ref().is_some_and(|b| reads(b.program.effects()));
    let writes = action.run.as_ref().is_some_and(|b| !b.program.own_writes().is_empty());
    (setup && !action.reset && !writes).then(|| "its value".to_string())
}
