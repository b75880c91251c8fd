use labspec_finding::{Example, Layer, Rule, Severity};

/// A token is in a place where it is not allowed.
pub const MISPLACED: &Rule = &Rule {
    code: "misplaced",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a token is in a place where it is not allowed",
    why: "JavaScript rejects the whole text",
    bad: Example::Statements("⟦else⟧ { ctx.a = 1 }"),
    good: Example::Statements("if (data.time > 1) { ctx.a = 0 } else { ctx.a = 1 }"),
};
