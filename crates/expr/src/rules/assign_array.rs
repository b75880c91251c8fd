use labspec_finding::{Example, Layer, Rule, Severity};

/// A whole array is assigned instead of one element.
pub const ASSIGN_ARRAY: &Rule = &Rule {
    code: "assign-array",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "a whole array is assigned instead of one element",
    why: "JavaScript throws there, or the field is replaced and the host never sees it",
    bad: Example::Statements("⟦data.qpos⟧ = 1"),
    good: Example::Statements("data.qpos[7] = 1"),
};
