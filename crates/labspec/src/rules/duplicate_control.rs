use super::Check;
use super::repeated::{DISTINCT, repeated};
use crate::spec::Lab;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// Two controls of a lab have the same label.
pub const DUPLICATE_CONTROL: &Rule = &Rule {
    code: "duplicate-control",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "two controls of a lab have the same label",
    why: "neither a student nor a run that sets controls by label can tell them apart",
    bad: Example::Lab(
        r#"{"model": "ball", "controls": [{"label": "push", "type": "button", "run": "data.qvel[0] = 1"}, {"label": "⟦push⟧", "type": "button", "run": "data.qvel[1] = 1"}]}"#,
    ),
    good: Example::Lab(
        r#"{"model": "ball", "controls": [{"label": "push along x", "type": "button", "run": "data.qvel[0] = 1"}, {"label": "push along y", "type": "button", "run": "data.qvel[1] = 1"}]}"#,
    ),
};

pub(super) const CHECK: Check = Check::Lab(check_lab);

fn check_lab(lab: &Lab, findings: &mut Vec<Finding>) {
    repeated(
        DUPLICATE_CONTROL,
        "controls have the label",
        DISTINCT,
        lab.authored_controls().iter().map(|c| &c.label),
        findings,
    );
}
