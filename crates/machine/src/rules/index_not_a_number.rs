use labspec_finding::{Example, Layer, Rule, Severity};

/// An index is not a number.
pub const INDEX_KIND: &Rule = &Rule {
    code: "index-not-a-number",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "an index is not a number",
    why: "JavaScript gives undefined, and a computation with it gives NaN",
    bad: Example::Expression("data.qpos[⟦true⟧]"),
    good: Example::Expression("data.qpos[1]"),
};
