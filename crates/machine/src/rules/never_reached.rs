use labspec_finding::{Example, Layer, Rule, Severity};

/// A statement follows a `return`, a `break` or a `continue`.
pub const UNREACHABLE: &Rule = &Rule {
    code: "never-reached",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a statement follows a `return`, a `break` or a `continue`",
    why: "the statement never runs",
    bad: Example::Statements("return; ⟦ctx.a = 1⟧"),
    good: Example::Statements("ctx.a = 1; return"),
};
