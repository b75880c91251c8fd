use labspec_finding::{Example, Layer, Rule, Severity};

/// An index that is not a number.
pub const INDEX_KIND: &Rule = &Rule {
    code: "index-not-a-number",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "an index that is not a number",
    why: "JavaScript gives undefined there, and a computation with it NaN",
    bad: Example::Expression("data.qpos[⟦true⟧]"),
    good: Example::Expression("data.qpos[1]"),
};
