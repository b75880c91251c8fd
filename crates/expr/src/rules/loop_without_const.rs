use labspec_finding::{Example, Layer, Rule, Severity};

/// The name of a `for … of` loop is not declared.
pub const LOOP_WITHOUT_CONST: &Rule = &Rule {
    code: "loop-without-const",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "the name of a `for … of` loop is not declared",
    why: "it would be a variable of all texts",
    bad: Example::Statements("for (⟦x⟧ of [1, 2]) { ctx.a = x }"),
    good: Example::Statements("for (const x of [1, 2]) { ctx.a = x }"),
};
