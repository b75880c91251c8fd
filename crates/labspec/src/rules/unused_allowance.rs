use crate::check::CheckLevel;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::ops::Range;

/// A suppression matches no finding.
pub const UNUSED_ALLOWANCE: &Rule = &Rule {
    code: "unused-allowance",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "a suppression matches no finding",
    why: "it would hide the finding if it came back, and nobody would review it",
    bad: Example::Lab(
        r#"{"model": "ball", "readouts": [{"label": "z", "expr": "data.qpos[2]"}], "lint": {"allow": ["⟦duplicate-readout⟧"], "why": "both are read"}}"#,
    ),
    good: Example::Lab(
        r#"{"model": "ball", "readouts": [{"label": "z", "expr": "data.qpos[2]"}, {"label": "z", "expr": "data.qpos[7]"}], "lint": {"allow": ["duplicate-readout"], "why": "both are read"}}"#,
    ),
};

/// Reports a suppression that matches no finding. `None` if a check at this level cannot decide that.
pub(crate) fn check_use(rule: &Rule, span: Range<usize>, level: CheckLevel) -> Option<Finding> {
    can_find(rule.layer, level).then(|| {
        Finding::new(UNUSED_ALLOWANCE, span, format!("`{}` matches no finding here", rule.code))
            .help("delete it")
    })
}

/// Whether a check at this level can report the rules of this layer.
fn can_find(layer: Layer, level: CheckLevel) -> bool {
    match layer {
        Layer::Run => level.labs,
        Layer::Claim => level.claims,
        Layer::Program => level.programs,
        _ => true,
    }
}
