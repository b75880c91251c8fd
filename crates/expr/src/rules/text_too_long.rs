use labspec_finding::{Example, Layer, Rule, Severity};

/// A string grew beyond the limit.
pub const TEXT_TOO_LONG: &Rule = &Rule {
    code: "text-too-long",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "a string grew beyond the limit",
    why: "the page of a student would stand still",
    bad: Example::Statements("ctx.a = ⟦'x'.repeat(1e9)⟧"),
    good: Example::Statements("ctx.a = 'x'.repeat(3)"),
};
