use labspec_finding::{Example, Layer, Rule, Severity};

/// An index that is not a whole number.
pub const INDEX_FRACTION: &Rule = &Rule {
    code: "index-not-whole",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "an index that is not a whole number",
    why: "JavaScript gives undefined there, and a computation with it NaN",
    bad: Example::Expression("data.qpos[⟦1.5⟧]"),
    good: Example::Expression("data.qpos[1]"),
};
