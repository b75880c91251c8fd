use labspec_finding::{Example, Layer, Rule, Severity};

/// A statement is used where only an expression is allowed.
pub const EXPRESSION_ONLY: &Rule = &Rule {
    code: "expression-only",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a statement is used where only an expression is allowed",
    why: "JavaScript rejects the whole text",
    bad: Example::Expression("⟦let⟧ a = 1; a"),
    good: Example::Expression("1"),
};
