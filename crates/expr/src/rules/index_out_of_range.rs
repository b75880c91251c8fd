use labspec_finding::{Example, Layer, Rule, Severity};

/// An index past the last element.
pub const INDEX_RANGE: &Rule = &Rule {
    code: "index-out-of-range",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "an index past the last element",
    why: "JavaScript gives undefined there, and a computation with it NaN",
    bad: Example::Expression("data.qpos[⟦8⟧]"),
    good: Example::Expression("data.qpos[7]"),
};
