use labspec_finding::{Example, Layer, Rule, Severity};

/// A declaration alone behind a condition or a loop.
pub const LONE_DECLARATION: &Rule = &Rule {
    code: "lone-declaration",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "a declaration alone behind a condition or a loop",
    why: "the name would be gone at once; JavaScript refuses it",
    bad: Example::Statements("if (data.time > 1) ⟦let⟧ a = 1"),
    good: Example::Statements("if (data.time > 1) { let a = 1; ctx.a = a }"),
};
