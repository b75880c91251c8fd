use labspec_finding::{Example, Layer, Rule, Severity};

/// A suppression matches no finding.
pub const UNUSED_ALLOWANCE: &Rule = &Rule {
    code: "unused-allowance",
    severity: Severity::Warning,
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
