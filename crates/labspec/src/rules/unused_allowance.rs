use labspec_finding::{Example, Layer, Rule, Severity};

/// An allowance of something that is not there.
pub const UNUSED_ALLOWANCE: &Rule = &Rule {
    code: "unused-allowance",
    severity: Severity::Warning,
    layer: Layer::Structure,
    summary: "something is allowed that is not found",
    why: "it would hide the finding once it is true again, and nobody would have looked at it",
    bad: Example::Lab(
        r#"{"model": "ball", "readouts": [{"label": "z", "expr": "data.qpos[2]"}], "lint": {"allow": ["⟦duplicate-readout⟧"], "why": "both are read"}}"#,
    ),
    good: Example::Lab(
        r#"{"model": "ball", "readouts": [{"label": "z", "expr": "data.qpos[2]"}, {"label": "z", "expr": "data.qpos[7]"}], "lint": {"allow": ["duplicate-readout"], "why": "both are read"}}"#,
    ),
};
