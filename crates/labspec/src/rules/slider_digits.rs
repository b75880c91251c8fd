use super::Check;
use crate::finding::Finding;
use crate::spec::{Control, ControlKind};
use labspec_finding::{Example, Layer, Rule, Severity};

/// Fewer digits than the step has.
pub const SLIDER_DIGITS: &Rule = &Rule {
    code: "slider-digits",
    severity: Severity::Warning,
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

pub(super) const CHECK: Check = Check::Control(check);

fn check(control: &Control, findings: &mut Vec<Finding>) {
    let ControlKind::Slider { min, max, step: Some(step), digits: Some(digits), .. } = &control.kind else {
        return;
    };
    let movable = step.value > 0.0 && step.value <= max.value - min.value;
    if !movable || !(0.0..=17.0).contains(&digits.value) {
        return;
    }
    let decimals = digits.value as usize;
    let near = [min.value, min.value + step.value, min.value + 2.0 * step.value];
    let shown = near.map(|x| format!("{x:.decimals$}"));
    // Small and large numbers are printed with an exponent, which has digits of its own.
    let plain = near.iter().all(|x| *x == 0.0 || (1e-3..1e5).contains(&x.abs()));
    let same = shown.windows(2).position(|pair| matches!(pair, [a, b] if a == b));
    let (Some(at), true) = (same, plain) else { return };
    let [Some(a), Some(b), Some(text)] =
        [near.get(at).map(f64::to_string), near.get(at + 1).map(f64::to_string), shown.get(at).cloned()]
    else {
        return;
    };
    findings.push(
        Finding::new(SLIDER_DIGITS, digits.span.clone(), format!("{a} and {b} are both shown as {text}"))
            .why("a student moves the slider by a step, and the number beside it stays")
            .related(step.span.clone(), "the step")
            .help("show as many decimals as the step has"),
    );
}
