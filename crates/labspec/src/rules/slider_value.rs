use super::Check;
use crate::spec::{Control, ControlKind};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// The start value of a slider is outside its range.
pub const SLIDER_VALUE: &Rule = &Rule {
    code: "slider-value",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "the start value of a slider is outside its range",
    why: "the page moves the slider to the nearest end, but the lab starts with the value written here",
    bad: Example::Lab(
        r#"{"model": "ball", "controls": [{"label": "friction", "set": "model.geom_friction[0]", "min": 1, "max": 2, "value": ⟦0.1⟧}]}"#,
    ),
    good: Example::Lab(
        r#"{"model": "ball", "controls": [{"label": "friction", "set": "model.geom_friction[0]", "min": 0.1, "max": 2, "value": 0.1}]}"#,
    ),
};

pub(super) const CHECK: Check = Check::Control(check_control);

fn check_control(control: &Control, findings: &mut Vec<Finding>) {
    let ControlKind::Slider { min, max, value, .. } = &control.kind else { return };
    // Another rule reports an empty range.
    if min.value < max.value && !(min.value..=max.value).contains(&value.value) {
        let end = if value.value < min.value { min } else { max };
        let message =
            format!("the start value {} is not between {} and {}", value.value, min.value, max.value);
        findings.push(
            Finding::new(SLIDER_VALUE, value.span.clone(), message)
                .related(end.span.clone(), "the nearest end")
                .help(format!(
                    "write {}, the nearest end, or widen the range to include {}",
                    end.value, value.value
                )),
        );
    }
}
