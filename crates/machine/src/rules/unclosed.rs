use labspec_finding::{Example, Layer, Rule, Severity};

/// A bracket is not closed.
pub const UNCLOSED: &Rule = &Rule {
    code: "unclosed",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a bracket is not closed",
    why: "JavaScript rejects the whole text",
    bad: Example::Expression("Math.sin⟦(⟧data.qpos[7]"),
    good: Example::Expression("Math.sin(data.qpos[7])"),
};
