use labspec_finding::{Example, Layer, Rule, Severity};

/// There is nothing to evaluate.
pub const EMPTY: &Rule = &Rule {
    code: "empty",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "there is nothing to evaluate",
    why: "a computation with it gives NaN",
    bad: Example::Expression("⟦⟧ "),
    good: Example::Expression("data.time"),
};
