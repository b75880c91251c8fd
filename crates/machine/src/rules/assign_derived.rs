use labspec_finding::{Example, Layer, Rule, Severity};

/// An assignment writes a computed field.
pub const ASSIGN_DERIVED: &Rule = &Rule {
    code: "assign-derived",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "an assignment writes a computed field",
    why: "the field is computed again, so the stored value is lost",
    bad: Example::Statements("⟦data.xpos[5]⟧ = 1"),
    good: Example::Statements("data.qpos[2] = 1"),
};
