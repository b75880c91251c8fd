use labspec_finding::{Example, Layer, Rule, Severity};

/// An expression chains two comparisons.
pub const CHAINED_COMPARISON: &Rule = &Rule {
    code: "chained-comparison",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Program,
    summary: "an expression chains two comparisons",
    why: "the second comparison compares a truth value: `0 < 5 < 3` is true",
    bad: Example::Expression("⟦0 < data.time < 1⟧"),
    good: Example::Expression("0 < data.time && data.time < 1"),
};
