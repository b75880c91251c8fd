use labspec_finding::{Example, Layer, Rule, Severity};

/// An index is negative.
pub const INDEX_NEGATIVE: &Rule = &Rule {
    code: "index-negative",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "an index is negative",
    why: "JavaScript gives undefined: indexes count from 0, never from the end",
    bad: Example::Expression("data.qpos[⟦-1⟧]"),
    good: Example::Expression("data.qpos[7]"),
};
