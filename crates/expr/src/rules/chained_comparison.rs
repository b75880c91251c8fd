use labspec_finding::{Example, Layer, Rule, Severity};

/// Two comparisons in a row.
pub const CHAINED_COMPARISON: &Rule = &Rule {
    code: "chained-comparison",
    severity: Severity::Warning,
    layer: Layer::Program,
    summary: "two comparisons in a row",
    why: "the second one compares a truth value: `0 < 5 < 3` is true",
    bad: Example::OfHost,
    good: Example::OfHost,
};
