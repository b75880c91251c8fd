use labspec_finding::{Example, Layer, Rule, Severity};

/// The variable of a `for … of` loop is not declared.
pub const LOOP_WITHOUT_CONST: &Rule = &Rule {
    code: "loop-without-const",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "the variable of a `for … of` loop is not declared",
    why: "it would become a global variable of every text",
    bad: Example::Statements("for (⟦x⟧ of [1, 2]) { ctx.a = x }"),
    good: Example::Statements("for (const x of [1, 2]) { ctx.a = x }"),
};
