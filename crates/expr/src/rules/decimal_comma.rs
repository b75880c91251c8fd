use labspec_finding::{Example, Layer, Rule, Severity};

/// A decimal comma.
pub const DECIMAL_COMMA: &Rule = &Rule {
    code: "decimal-comma",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "a decimal comma",
    why: "a comma separates things; the decimal sign is a point",
    bad: Example::Expression("data.qpos[7] * ⟦0,5⟧"),
    good: Example::Expression("data.qpos[7] * 0.5"),
};
