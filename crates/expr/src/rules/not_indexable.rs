use labspec_finding::{Example, Layer, Rule, Severity};

/// An index behind something that has no elements.
pub const NOT_INDEXABLE: &Rule = &Rule {
    code: "not-indexable",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "an index behind something that has no elements",
    why: "JavaScript gives undefined there, and a computation with it NaN",
    bad: Example::Expression("⟦data.time[0]⟧"),
    good: Example::Expression("data.time"),
};
