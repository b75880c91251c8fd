use super::Check;
use crate::spec::{Control, ControlKind};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// The start value of a select is not one of its options.
pub const SELECT_VALUE: &Rule = &Rule {
    code: "select-value",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "the start value of a select is not one of its options",
    why: "the page shows the first option, but the lab starts with the value written here",
    bad: Example::Lab(
        r#"{"model": "ball", "controls": [{"type": "select", "label": "integrator", "set": "model.opt.integrator", "options": [["Euler", 0], ["RK4", 1]], "value": ⟦3⟧}]}"#,
    ),
    good: Example::Lab(
        r#"{"model": "ball", "controls": [{"type": "select", "label": "integrator", "set": "model.opt.integrator", "options": [["Euler", 0], ["RK4", 1]], "value": 1}]}"#,
    ),
};

pub(super) const CHECK: Check = Check::Control(check_control);

fn check_control(control: &Control, findings: &mut Vec<Finding>) {
    let ControlKind::Select { options, value, .. } = &control.kind else { return };
    if !options.is_empty() && !options.iter().any(|o| o.value.same(value)) {
        let all: Vec<String> = options.iter().take(8).map(|o| o.value.show()).collect();
        findings.push(
            Finding::new(SELECT_VALUE, value.span(), format!("{} is not one of the options", value.show()))
                .help(format!("use one of their values: {}", all.join(", "))),
        );
    }
}
