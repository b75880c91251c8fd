use labspec_finding::{Example, Layer, Rule, Severity};

/// An expression contains `=`.
pub const ASSIGN_INSIDE: &Rule = &Rule {
    code: "assign-inside",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "an expression contains `=`",
    why: "`=` stores a value; a comparison was probably meant",
    bad: Example::Statements("if (data.ncon ⟦=⟧ 1) { ctx.a = 1 }"),
    good: Example::Statements("if (data.ncon === 1) { ctx.a = 1 }"),
};
