use labspec_finding::{Example, Layer, Rule, Severity};

/// `allow` names an unknown rule.
pub const UNKNOWN_RULE: &Rule = &Rule {
    code: "unknown-rule",
    severity: Severity::Warning,
    layer: Layer::Structure,
    summary: "`allow` names an unknown rule",
    why: "it suppresses nothing: the intended finding is still reported",
    bad: Example::Lab(
        r#"{"model": "ball", "readouts": [{"label": "z", "expr": "data.qpos[2]"}], "lint": {"allow": ["⟦duplicate-readouts⟧"], "why": "both are read"}}"#,
    ),
    good: Example::Lab(r#"{"model": "ball", "readouts": [{"label": "z", "expr": "data.qpos[2]"}]}"#),
};
