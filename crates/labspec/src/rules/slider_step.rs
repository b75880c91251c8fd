use super::Check;
use crate::spec::{Control, ControlKind};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// The step of a slider is not positive, or larger than its range.
pub const SLIDER_STEP: &Rule = &Rule {
    code: "slider-step",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "the step of a slider is not positive, or larger than its range",
    why: "the slider cannot move",
    bad: Example::Lab(
        r#"{"model": "ball", "controls": [{"label": "friction", "set": "model.geom_friction[0]", "min": 1, "max": 2, "step": ⟦10⟧, "value": 1}]}"#,
    ),
    good: Example::Lab(
        r#"{"model": "ball", "controls": [{"label": "friction", "set": "model.geom_friction[0]", "min": 1, "max": 2, "step": 0.1, "value": 1}]}"#,
    ),
};

pub(super) const CHECK: Check = Check::Control(check_control);

fn check_control(control: &Control, findings: &mut Vec<Finding>) {
    let ControlKind::Slider { min, max, step: Some(step), .. } = &control.kind else { return };
    let range = max.value - min.value;
    if range > 0.0 && (step.value <= 0.0 || step.value > range) {
        let message =
            format!("the step {} does not fit the range from {} to {}", step.value, min.value, max.value);
        findings.push(
            Finding::new(SLIDER_STEP, step.span.clone(), message)
                .help(format!("delete `step` for a hundredth of the range, {}", range / 100.0)),
        );
    }
}
