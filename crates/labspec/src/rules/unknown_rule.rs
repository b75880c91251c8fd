use labspec_finding::{Example, Layer, Rule, Severity};

/// An allowance of something that no rule is called.
pub const UNKNOWN_RULE: &Rule = &Rule {
    code: "unknown-rule",
    severity: Severity::Warning,
    layer: Layer::Structure,
    summary: "something is allowed that no rule is called",
    why: "nothing is allowed by it: what was meant is told all the same",
    bad: Example::Lab(
        r#"{"model": "ball", "readouts": [{"label": "z", "expr": "data.qpos[2]"}], "lint": {"allow": ["⟦duplicate-readouts⟧"], "why": "both are read"}}"#,
    ),
    good: Example::Lab(r#"{"model": "ball", "readouts": [{"label": "z", "expr": "data.qpos[2]"}]}"#),
};
