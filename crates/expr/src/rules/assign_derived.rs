use labspec_finding::{Example, Layer, Rule, Severity};

/// A computed field is assigned.
pub const ASSIGN_DERIVED: &Rule = &Rule {
    code: "assign-derived",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "a computed field is assigned",
    why: "it is computed anew, and what was stored is gone",
    bad: Example::Statements("⟦data.xpos[5]⟧ = 1"),
    good: Example::Statements("data.qpos[2] = 1"),
};
