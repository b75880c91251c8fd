use super::Check;
use crate::spec::{Control, ControlKind};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// The start value of a slider is between two of its steps.
pub const SLIDER_GRID: &Rule = &Rule {
    code: "slider-grid",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "the start value of a slider is between two of its steps",
    why: "the slider shows another value than the lab starts with, and a student who moves it cannot return",
    bad: Example::Lab(
        r#"{"model": "ball", "controls": [{"label": "gravity", "set": "model.opt.gravity[2]", "min": -20, "max": -1, "step": 1, "value": ⟦-9.81⟧}]}"#,
    ),
    good: Example::Lab(
        r#"{"model": "ball", "controls": [{"label": "gravity", "set": "model.opt.gravity[2]", "min": -20, "max": -1, "step": 0.01, "value": -9.81}]}"#,
    ),
};

pub(super) const CHECK: Check = Check::Control(check_control);

/// The maximum distance of a value from the grid by rounding, in steps.
const ROUNDING: f64 = 1e-6;

fn check_control(control: &Control, findings: &mut Vec<Finding>) {
    let ControlKind::Slider { min, max, step: Some(step), value, .. } = &control.kind else { return };
    let inside = (min.value..=max.value).contains(&value.value) && step.value > 0.0;
    let steps = (value.value - min.value) / step.value;
    // The end of a range may be between two steps, and another rule reports a step that is larger than the range.
    let ends = value.value == max.value || step.value > max.value - min.value;
    if !inside || ends || (steps - steps.round()).abs() <= ROUNDING {
        return;
    }
    let near = [steps.floor(), steps.ceil()].map(|n| without_rounding(min.value + n * step.value));
    let [below, above] = near;
    let message = format!("{} is between two steps of the slider, {below} and {above}", value.value);
    findings.push(
        Finding::new(SLIDER_GRID, value.span.clone(), message)
            .why("the page shows one of the two while the lab starts with this value, and a student cannot return to it")
            .related(step.span.clone(), format!("steps count from {}", min.value))
            .help(format!("write {below} or {above}, or choose a step that reaches {}", value.value)),
    );
}

/// A number without the last digits, which contain rounding errors.
fn without_rounding(x: f64) -> f64 {
    format!("{x:.12e}").parse().unwrap_or(x)
}
