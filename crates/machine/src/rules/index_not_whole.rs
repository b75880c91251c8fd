use labspec_finding::{Example, Layer, Rule, Severity};

/// An index is not an integer.
pub const INDEX_FRACTION: &Rule = &Rule {
    code: "index-not-whole",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "an index is not an integer",
    why: "JavaScript gives undefined, and a computation with it gives NaN",
    bad: Example::Expression("data.qpos[⟦1.5⟧]"),
    good: Example::Expression("data.qpos[1]"),
};
