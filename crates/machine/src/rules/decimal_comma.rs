use labspec_finding::{Example, Layer, Rule, Severity};

/// A number has a decimal comma.
pub const DECIMAL_COMMA: &Rule = &Rule {
    code: "decimal-comma",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a number has a decimal comma",
    why: "a comma separates values; the decimal separator is a point",
    bad: Example::Expression("data.qpos[7] * ⟦0,5⟧"),
    good: Example::Expression("data.qpos[7] * 0.5"),
};
