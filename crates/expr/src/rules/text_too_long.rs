use labspec_finding::{Example, Layer, Rule, Severity};

/// A string grew beyond the limit.
pub const TEXT_TOO_LONG: &Rule = &Rule {
    code: "text-too-long",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "a string grew beyond the limit",
    why: "whoever waits for it would wait forever",
    bad: Example::Statements("ctx.a = ⟦'x'.repeat(1e9)⟧"),
    good: Example::Statements("ctx.a = 'x'.repeat(3)"),
};
