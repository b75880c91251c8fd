use labspec_finding::{Example, Layer, Rule, Severity};

/// Function calls are nested too deeply.
pub const CALL_DEPTH: &Rule = &Rule {
    code: "calls-too-deep",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "function calls are nested too deeply",
    why: "JavaScript throws when its stack is full",
    bad: Example::Statements("const f = n => ⟦f(n + 1)⟧ + 1; ctx.a = f(0)"),
    good: Example::Statements("const f = n => n + 1; ctx.a = f(0)"),
};
