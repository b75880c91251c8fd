use labspec_finding::{Example, Layer, Rule, Severity};

/// A condition or a loop has no body.
pub const MISSING_STATEMENT: &Rule = &Rule {
    code: "missing-statement",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a condition or a loop has no body",
    why: "JavaScript rejects the whole text",
    bad: Example::Statements("if (data.time > 1)⟦⟧"),
    good: Example::Statements("if (data.time > 1) { ctx.a = 1 }"),
};
