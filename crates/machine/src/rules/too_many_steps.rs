use labspec_finding::{Example, Layer, Rule, Severity};

/// A loop or a recursion does not end within the step budget.
pub const BUDGET: &Rule = &Rule {
    code: "too-many-steps",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a loop or a recursion does not end within the step budget",
    why: "without a budget the page would hang",
    bad: Example::Statements("while (⟦true⟧) { ctx.a = 1 }"),
    good: Example::Statements("for (let i = 0; i < 3; i++) { ctx.a = i }"),
};
