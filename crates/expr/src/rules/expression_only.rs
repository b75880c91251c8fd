use labspec_finding::{Example, Layer, Rule, Severity};

/// A statement stands where only an expression is read.
pub const EXPRESSION_ONLY: &Rule = &Rule {
    code: "expression-only",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "a statement stands where only an expression is read",
    why: "JavaScript refuses the whole text",
    bad: Example::Expression("⟦let⟧ a = 1; a"),
    good: Example::Expression("1"),
};
