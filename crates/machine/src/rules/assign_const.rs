use labspec_finding::{Example, Layer, Rule, Severity};

/// A name declared with `const` is assigned again.
pub const ASSIGN_CONST: &Rule = &Rule {
    code: "assign-const",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a name declared with `const` is assigned again",
    why: "JavaScript throws",
    bad: Example::Statements("const a = 1; ⟦a⟧ = 2; ctx.a = a"),
    good: Example::Statements("let a = 1; a = 2; ctx.a = a"),
};
