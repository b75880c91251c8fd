use labspec_finding::{Example, Layer, Rule, Severity};

/// An element is stored twice in a row.
pub const STORED_TWICE: &Rule = &Rule {
    code: "stored-twice",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Program,
    summary: "an element is stored twice in a row",
    why: "the value of the first statement is lost: one of the two indexes is probably wrong",
    bad: Example::Statements("⟦data.qvel[0]⟧ = 1; data.qvel[0] = 2"),
    good: Example::Statements("data.qvel[0] = 1; data.qvel[1] = 2"),
};
