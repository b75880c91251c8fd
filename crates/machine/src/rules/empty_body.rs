use labspec_finding::{Example, Layer, Rule, Severity};

/// A `;` directly follows the head of a condition or a loop.
pub const EMPTY_BODY: &Rule = &Rule {
    code: "empty-body",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a `;` directly follows the head of a condition or a loop",
    why: "the condition decides nothing: the code that follows always runs",
    bad: Example::Statements("if (data.time > 1)⟦;⟧ ctx.a = 1"),
    good: Example::Statements("if (data.time > 1) ctx.a = 1"),
};
