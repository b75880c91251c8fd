use labspec_finding::{Example, Layer, Rule, Severity};

/// A `const` or a pattern has no value.
pub const DECLARED_WITHOUT_VALUE: &Rule = &Rule {
    code: "declared-without-value",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a `const` or a pattern has no value",
    why: "the name can never change, so it needs its value at once",
    bad: Example::Statements("const ⟦a⟧; ctx.a = a"),
    good: Example::Statements("const a = 1; ctx.a = a"),
};
