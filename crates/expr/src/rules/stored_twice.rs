use labspec_finding::{Example, Layer, Rule, Severity};

/// An element is stored twice in a row.
pub const STORED_TWICE: &Rule = &Rule {
    code: "stored-twice",
    severity: Severity::Warning,
    layer: Layer::Program,
    summary: "an element is stored, and at once stored again",
    why: "what the first statement stores is lost: one of the two indexes is hardly the one that is meant",
    bad: Example::Statements("⟦data.qvel[0]⟧ = 1; data.qvel[0] = 2"),
    good: Example::Statements("data.qvel[0] = 1; data.qvel[1] = 2"),
};
