use labspec_finding::{Example, Layer, Rule, Severity};

/// A whole array stands where one number must stand.
pub const WHOLE_ARRAY: &Rule = &Rule {
    code: "whole-array",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "a whole array stands where one number must stand",
    why: "JavaScript makes a text of it, and a computation with it gives NaN",
    bad: Example::Expression("⟦data.qpos⟧ * 2"),
    good: Example::Expression("data.qpos[7] * 2"),
};
