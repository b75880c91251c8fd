use labspec_finding::{Example, Layer, Rule, Severity};

/// A declaration is the only statement of a condition or a loop.
pub const LONE_DECLARATION: &Rule = &Rule {
    code: "lone-declaration",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a declaration is the only statement of a condition or a loop",
    why: "the name would disappear at once; JavaScript rejects it",
    bad: Example::Statements("if (data.time > 1) ⟦let⟧ a = 1"),
    good: Example::Statements("if (data.time > 1) { let a = 1; ctx.a = a }"),
};
