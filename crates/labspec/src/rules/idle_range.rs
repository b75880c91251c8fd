//! Sliders whose statements set the same values over a part of their range, because they clamp the value.
//!
//! The values that a slider sets are compared bit for bit, in all fields and variables that it writes, without a run.

use crate::bind::{Bound, ControlProgram};
use crate::check::observations::{ObservedLab, longest_equal};
use crate::spec::ControlKind;
use labspec_core::reflect::FieldId;
use labspec_expr::{FieldKey, Host, Value};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A part of the range of a slider changes nothing that a student can see.
pub const IDLE_RANGE: &Rule = &Rule {
    code: "idle-range",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "a part of the range of a slider changes nothing that a student can see",
    why: "a student moves it, and every curve, number and position stays exactly the same: `ctrlrange`, a limit or a statement of the lab clamps the value",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "controls": [{"label": "⟦gravity⟧", "apply": "model.opt.gravity[2] = -Math.min(value, 10)", "min": 0, "max": 30, "value": 10}], "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "controls": [{"label": "gravity", "apply": "model.opt.gravity[2] = -value", "min": 0, "max": 30, "value": 10}], "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]}"#,
    ),
};

/// The number of tested values.
const TESTED_VALUES: usize = 25;
/// The minimum length of a reported part, as a fraction of the range.
const MIN_SHARE: f64 = 0.3;
/// The maximum number of compared numbers.
const MAX_NUMBERS: usize = 2000;

pub(crate) fn check_flat_ranges(observed: &mut ObservedLab<'_>, findings: &mut Vec<Finding>) {
    let ready = observed.bench.ready;
    for (index, control) in ready.lab.controls.iter().enumerate() {
        let Some((_, ControlProgram::Change(_, action))) = ready.programs.controls.get(index) else {
            continue;
        };
        let (Some(bound), ControlKind::Slider { min, max, .. }) = (action.run.as_ref(), &control.kind) else {
            continue;
        };
        let step = control.step().filter(|s| *s > 0.0 && min.value < max.value).unwrap_or(f64::NAN);
        let steps = ((max.value - min.value) / step).round();
        if observed.reported.contains(&index) || !(2.0..1e6).contains(&steps) || action.param.is_some() {
            continue;
        }
        // Every step of the slider, or this many of them.
        let count = (steps as usize).min(TESTED_VALUES);
        let value_at =
            |i: usize| (min.value + (i as f64 * steps / count as f64).round() * step).min(max.value);
        let values: Vec<f64> = (0..=count).map(value_at).collect();
        let Some(sets) =
            values.iter().map(|v| writes(observed, index, bound, *v)).collect::<Option<Vec<_>>>()
        else {
            continue;
        };
        let flat = longest_equal(&sets);
        let [Some(low), Some(high)] = [values.get(flat.start), values.get(flat.end - 1)] else { continue };
        let share = (high - low) / (max.value - min.value);
        // A staircase is flat nearly everywhere, which is intended.
        let stairs = sets
            .windows(2)
            .enumerate()
            .any(|(i, w)| !(flat.start..flat.end - 1).contains(&i) && matches!(w, [a, b] if a == b));
        if stairs || share < MIN_SHARE || flat.len() == sets.len() || flat.len() < 2 {
            continue;
        }
        let label = &control.label.value;
        let [low, high] = [low, high].map(|x| crate::check::setconst::digits(*x, 6));
        findings.push(
            Finding::warning(
                IDLE_RANGE,
                control.label.span(),
                format!("from {low} to {high}, \"{label}\" always sets the same value"),
            )
            .why(format!(
                "{} values were tested, and everything that these {} write is the same to the last bit",
                sets.len(),
                flat.len()
            ))
            .help("check what clamps the value, or end the slider there")
            .related(bound.text.span(), "this is what it sets"),
        );
        observed.reported.push(index);
    }
}

/// All values that a control writes at a position of its slider. `None` if they are not known.
fn writes(observed: &ObservedLab<'_>, index: usize, bound: &Bound, value: f64) -> Option<Vec<u64>> {
    let effects = bound.program.effects();
    if effects.any_ctx || effects.calls_values {
        return None;
    }
    let mut session = observed.bench.start();
    session.set_control(index, Value::Number(value));
    let mut all = Vec::new();
    for write in bound.program.own_writes() {
        let key = FieldKey(FieldId::new(write.field.0 as usize)?.index() as u32);
        let end = write.count.map_or(session.world.len(key), |n| write.first + n);
        if all.len() + end.saturating_sub(write.first) > MAX_NUMBERS {
            return None;
        }
        all.extend((write.first..end).map(|i| session.world.get(key, i).map_or(u64::MAX, f64::to_bits)));
    }
    for slot in &effects.ctx_writes {
        match session.context.get(*slot) {
            Value::Number(x) => all.push(x.to_bits()),
            Value::Boolean(b) => all.push(u64::from(*b)),
            _ => return None,
        }
    }
    (!all.is_empty() && session.ended().is_none() && session.program_errors.is_empty()).then_some(all)
}
