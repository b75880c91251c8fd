use super::Check;
use crate::spec::format::{MAX_DIGITS, READOUT, SLIDER};
use crate::spec::{ControlKind, Lab};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// `digits` is not between 0 and 17.
pub const DIGITS_RANGE: &Rule = &Rule {
    code: "digits-range",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "`digits` is not between 0 and 17",
    why: "a number has at most 17 significant digits; a negative count makes the page throw",
    bad: Example::Lab(
        r#"{"model": "ball", "readouts": [{"label": "t", "expr": "data.time", "digits": ⟦-1⟧}]}"#,
    ),
    good: Example::Lab(
        r#"{"model": "ball", "readouts": [{"label": "t", "expr": "data.time", "digits": 1}]}"#,
    ),
};

pub(super) const CHECK: Check = Check::Lab(check_lab);

fn check_lab(lab: &Lab, findings: &mut Vec<Finding>) {
    let of_control = |kind: &ControlKind| match kind {
        ControlKind::Slider { digits, .. } => digits.clone(),
        _ => None,
    };
    let sliders = lab.controls.iter().filter_map(|c| of_control(&c.kind)).map(|n| (&SLIDER, n));
    let readouts = lab.readouts.iter().filter_map(|r| r.digits.clone()).map(|n| (&READOUT, n));
    for (_, n) in sliders.chain(readouts).filter(|(object, n)| !object.allows("digits", n.value)) {
        findings.push(
            Finding::new(
                DIGITS_RANGE,
                n.span.clone(),
                format!("`digits` is {}, not between 0 and {MAX_DIGITS}", n.value),
            )
            .help("write the number of decimals, or delete it for 3"),
        );
    }
}
