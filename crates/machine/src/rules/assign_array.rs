use labspec_finding::{Example, Layer, Rule, Severity};

/// An assignment replaces a whole array instead of one element.
pub const ASSIGN_ARRAY: &Rule = &Rule {
    code: "assign-array",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "an assignment replaces a whole array instead of one element",
    why: "JavaScript throws, or replaces the field, and the model never sees the new values",
    bad: Example::Statements("⟦data.qpos⟧ = 1"),
    good: Example::Statements("data.qpos[7] = 1"),
};
