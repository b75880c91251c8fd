use labspec_finding::{Example, Layer, Rule, Severity};

/// An object or a function is used as a value.
pub const NOT_A_VALUE: &Rule = &Rule {
    code: "not-a-value",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "an object or a function is used as a value",
    why: "JavaScript converts it to a string, and a computation with it gives NaN",
    bad: Example::Expression("⟦data⟧ + 1"),
    good: Example::Expression("data.time + 1"),
};
