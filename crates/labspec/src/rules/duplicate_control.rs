use super::Check;
use super::repeated::{DISTINCT, repeated};
use crate::finding::Finding;
use crate::spec::Lab;
use labspec_finding::{Example, Layer, Rule, Severity};

/// Two controls with one label.
pub const DUPLICATE_CONTROL: &Rule = &Rule {
    code: "duplicate-control",
    severity: Severity::Warning,
    layer: Layer::Structure,
    summary: "two controls of a lab have the same label",
    why: "a student cannot tell them apart, and neither can a run that sets controls by their labels",
    bad: Example::Lab(
        r#"{"model": "ball", "controls": [{"label": "push", "type": "button", "run": "data.qvel[0] = 1"}, {"label": "⟦push⟧", "type": "button", "run": "data.qvel[1] = 1"}]}"#,
    ),
    good: Example::Lab(
        r#"{"model": "ball", "controls": [{"label": "push along x", "type": "button", "run": "data.qvel[0] = 1"}, {"label": "push along y", "type": "button", "run": "data.qvel[1] = 1"}]}"#,
    ),
};

pub(super) const CHECK: Check = Check::Lab(check);

fn check(lab: &Lab, findings: &mut Vec<Finding>) {
    repeated(
        DUPLICATE_CONTROL,
        "controls have the label",
        DISTINCT,
        lab.controls.iter().map(|c| &c.label),
        findings,
    );
}
