use labspec_finding::{Example, Layer, Rule, Severity};

/// An index follows a value that has no elements.
pub const NOT_INDEXABLE: &Rule = &Rule {
    code: "not-indexable",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "an index follows a value that has no elements",
    why: "JavaScript gives undefined, and a computation with it gives NaN",
    bad: Example::Expression("⟦data.time[0]⟧"),
    good: Example::Expression("data.time"),
};
