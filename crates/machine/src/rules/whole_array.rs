use labspec_finding::{Example, Layer, Rule, Severity};

/// A whole array is used where a single number is required.
pub const WHOLE_ARRAY: &Rule = &Rule {
    code: "whole-array",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a whole array is used where a single number is required",
    why: "JavaScript converts it to a string, and a computation with it gives NaN",
    bad: Example::Expression("⟦data.qpos⟧ * 2"),
    good: Example::Expression("data.qpos[7] * 2"),
};
