use labspec_finding::{Example, Layer, Rule, Severity};

/// A loop or a recursion that does not come to an end.
pub const BUDGET: &Rule = &Rule {
    code: "too-many-steps",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "a loop or a recursion that does not come to an end",
    why: "whoever waits for it would wait forever",
    bad: Example::Statements("while (⟦true⟧) { ctx.a = 1 }"),
    good: Example::Statements("for (let i = 0; i < 3; i++) { ctx.a = i }"),
};
