use labspec_finding::{Example, Layer, Rule, Severity};

/// Something is called that is not a function.
pub const NOT_CALLABLE: &Rule = &Rule {
    code: "not-callable",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "something is called that is not a function",
    why: "JavaScript throws there",
    bad: Example::Expression("⟦data.time⟧()"),
    good: Example::Expression("data.time"),
};
