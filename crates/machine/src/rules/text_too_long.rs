use labspec_finding::{Example, Layer, Rule, Severity};

/// A string grows beyond the limit.
pub const TEXT_TOO_LONG: &Rule = &Rule {
    code: "text-too-long",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a string grows beyond the limit",
    why: "without a limit the page could hang",
    bad: Example::Statements("ctx.a = ⟦'x'.repeat(1e9)⟧"),
    good: Example::Statements("ctx.a = 'x'.repeat(3)"),
};
