use labspec_finding::{Example, Layer, Rule, Severity};

/// An index is past the last element.
pub const INDEX_RANGE: &Rule = &Rule {
    code: "index-out-of-range",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "an index is past the last element",
    why: "JavaScript gives undefined, and a computation with it gives NaN",
    bad: Example::Expression("data.qpos[⟦8⟧]"),
    good: Example::Expression("data.qpos[7]"),
};
