use labspec_finding::{Example, Layer, Rule, Severity};

/// A `do` loop has no `while`.
pub const DO_WITHOUT_WHILE: &Rule = &Rule {
    code: "do-without-while",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a `do` loop has no `while`",
    why: "nothing says when the loop ends",
    bad: Example::Statements("do { ctx.a = 1 }⟦⟧"),
    good: Example::Statements("do { ctx.a = 1 } while (data.time < 0)"),
};
