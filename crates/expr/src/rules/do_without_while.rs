use labspec_finding::{Example, Layer, Rule, Severity};

/// A `do` loop without its `while`.
pub const DO_WITHOUT_WHILE: &Rule = &Rule {
    code: "do-without-while",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "a `do` loop without its `while`",
    why: "nothing says when it ends",
    bad: Example::OfHost,
    good: Example::OfHost,
};
