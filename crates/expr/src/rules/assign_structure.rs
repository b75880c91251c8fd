use labspec_finding::{Example, Layer, Rule, Severity};

/// A size, a type or an address is assigned.
pub const ASSIGN_STRUCTURE: &Rule = &Rule {
    code: "assign-structure",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "a size, a type or an address is assigned",
    why: "it is fixed from the start: the host would read what is not there",
    bad: Example::Statements("⟦model.nq⟧ = 9"),
    good: Example::Statements("model.body_mass[1] = 9; mj.mj_setConst(model, data)"),
};
