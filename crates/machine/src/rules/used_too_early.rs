use labspec_finding::{Example, Layer, Rule, Severity};

/// A local name is used before its declaration.
pub const USED_TOO_EARLY: &Rule = &Rule {
    code: "used-too-early",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a local name is used before its declaration",
    why: "JavaScript throws",
    bad: Example::Statements("ctx.x = ⟦x⟧; const x = 1"),
    good: Example::Statements("const x = 1; ctx.x = x"),
};
