use super::Check;
use crate::json::Scalar;
use crate::json::read::named;
use crate::spec::{Control, ControlKind};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// Two options of a select have the same value.
pub const OPTION_VALUE_TWICE: &Rule = &Rule {
    code: "option-value-twice",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "two options of a select have the same value",
    why: "a student chooses the other option, and the lab stays the same",
    bad: Example::Lab(
        r#"{"model": "ball", "controls": [{"type": "select", "label": "integrator", "set": "model.opt.integrator", "options": [["Euler", 0], ["RK4", ⟦0⟧]], "value": 0}]}"#,
    ),
    good: Example::Lab(
        r#"{"model": "ball", "controls": [{"type": "select", "label": "integrator", "set": "model.opt.integrator", "options": [["Euler", 0], ["RK4", 1]], "value": 0}]}"#,
    ),
};

pub(super) const CHECK: Check = Check::Control(check_control);

fn same(a: &Scalar, b: &Scalar) -> bool {
    match (a, b) {
        (Scalar::Number(a), Scalar::Number(b)) => a.value == b.value,
        (Scalar::Text(a), Scalar::Text(b)) => a.as_str() == b.as_str(),
        (Scalar::Bool(a, _), Scalar::Bool(b, _)) => a == b,
        _ => false,
    }
}

fn check_control(control: &Control, findings: &mut Vec<Finding>) {
    let ControlKind::Select { options, .. } = &control.kind else { return };
    for (i, option) in options.iter().enumerate().take(MAX_OPTIONS) {
        // Another rule reports two options with the same text.
        let twin = options.iter().take(i).find(|o| same(&o.value, &option.value));
        if let Some(first) = twin {
            let [a, b] = [first, option].map(|o| named(o.text.as_str()));
            findings.push(
                Finding::new(
                    OPTION_VALUE_TWICE,
                    option.value.span(),
                    format!("{a} and {b} have the same value"),
                )
                .related(first.value.span(), "the first one")
                .help("write the value that belongs to the text, or delete one of them"),
            );
        }
    }
}

/// The maximum number of options that are compared.
const MAX_OPTIONS: usize = 200;
