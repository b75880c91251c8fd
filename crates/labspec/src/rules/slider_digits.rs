use super::Check;
use crate::spec::{Control, ControlKind};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A slider shows fewer decimals than its step has.
pub const SLIDER_DIGITS: &Rule = &Rule {
    code: "slider-digits",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "a slider shows fewer decimals than its step has",
    why: "neighbouring values look the same",
    bad: Example::Lab(
        r#"{"model": "ball", "controls": [{"label": "gravity", "set": "model.opt.gravity[2]", "min": -10, "max": 0, "step": 0.05, "value": -5, "digits": ⟦0⟧}]}"#,
    ),
    good: Example::Lab(
        r#"{"model": "ball", "controls": [{"label": "gravity", "set": "model.opt.gravity[2]", "min": -10, "max": 0, "step": 0.05, "value": -5, "digits": 2}]}"#,
    ),
};

/// The maximum number of steps of a slider that are compared.
const MAX_STEPS: f64 = 100.0;

/// Removes the rounding error of a number.
fn without_rounding(x: f64) -> f64 {
    format!("{x:.12e}").parse().unwrap_or(x)
}

pub(super) const CHECK: Check = Check::Control(check_control);

fn check_control(control: &Control, findings: &mut Vec<Finding>) {
    let ControlKind::Slider { min, max, step: Some(step), digits: Some(digits), .. } = &control.kind else {
        return;
    };
    let movable = step.value > 0.0 && step.value <= max.value - min.value;
    if !movable || !(0.0..=17.0).contains(&digits.value) {
        return;
    }
    let decimals = digits.value as usize;
    // Small and large numbers are printed with an exponent, whose digits differ.
    let plain = |x: f64| x == 0.0 || (1e-3..1e5).contains(&x.abs());
    let printed = |x: f64| format!("{x:.decimals$}");
    let steps = ((max.value - min.value) / step.value).min(MAX_STEPS) as usize;
    let pairs = (0..steps).map(|i| [i, i + 1].map(|i| without_rounding(min.value + i as f64 * step.value)));
    let Some([a, b]) = pairs.into_iter().find(|[a, b]| plain(*a) && plain(*b) && printed(*a) == printed(*b))
    else {
        return;
    };
    let text = printed(a);
    findings.push(
        Finding::new(SLIDER_DIGITS, digits.span.clone(), format!("{a} and {b} are both displayed as {text}"))
            .why("a student moves the slider by one step, and the number beside it does not change")
            .related(step.span.clone(), "the step")
            .help("display as many decimals as the step has"),
    );
}
