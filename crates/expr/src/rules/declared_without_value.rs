use labspec_finding::{Example, Layer, Rule, Severity};

/// A `const` or a pattern gets no value.
pub const DECLARED_WITHOUT_VALUE: &Rule = &Rule {
    code: "declared-without-value",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "a `const` or a pattern gets no value",
    why: "a name that never changes needs its value at once",
    bad: Example::OfHost,
    good: Example::OfHost,
};
