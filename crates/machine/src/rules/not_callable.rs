use labspec_finding::{Example, Layer, Rule, Severity};

/// An expression calls something that is not a function.
pub const NOT_CALLABLE: &Rule = &Rule {
    code: "not-callable",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "an expression calls something that is not a function",
    why: "JavaScript throws",
    bad: Example::Expression("⟦data.time⟧()"),
    good: Example::Expression("data.time"),
};
