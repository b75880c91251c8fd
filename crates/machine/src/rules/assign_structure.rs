use labspec_finding::{Example, Layer, Rule, Severity};

/// An assignment writes a size, a type or an address.
pub const ASSIGN_STRUCTURE: &Rule = &Rule {
    code: "assign-structure",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "an assignment writes a size, a type or an address",
    why: "the compiled model fixes it: a run would read memory that does not exist",
    bad: Example::Statements("⟦model.nq⟧ = 9"),
    good: Example::Statements("model.body_mass[1] = 9; mj.mj_setConst(model, data)"),
};
