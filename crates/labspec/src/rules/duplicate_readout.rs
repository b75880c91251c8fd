use super::Check;
use super::repeated::{DISTINCT, repeated};
use crate::spec::Lab;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// Two readouts of a lab have the same label.
pub const DUPLICATE_READOUT: &Rule = &Rule {
    code: "duplicate-readout",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "two readouts of a lab have the same label",
    why: "a student cannot tell them apart",
    bad: Example::Lab(
        r#"{"model": "ball", "readouts": [{"label": "z", "expr": "data.qpos[2]"}, {"label": "⟦z⟧", "expr": "data.qpos[7]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"model": "ball", "readouts": [{"label": "height", "expr": "data.qpos[2]"}, {"label": "angle", "expr": "data.qpos[7]"}]}"#,
    ),
};

pub(super) const CHECK: Check = Check::Lab(check_lab);

fn check_lab(lab: &Lab, findings: &mut Vec<Finding>) {
    repeated(
        DUPLICATE_READOUT,
        "readouts have the label",
        DISTINCT,
        lab.readouts.iter().map(|r| &r.label),
        findings,
    );
}
