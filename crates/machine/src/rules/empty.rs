use labspec_finding::{Example, Layer, Rule, Severity};

/// The expression is empty.
pub const EMPTY: &Rule = &Rule {
    code: "empty",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "the expression is empty",
    why: "a computation with it gives NaN",
    bad: Example::Expression("⟦⟧ "),
    good: Example::Expression("data.time"),
};
