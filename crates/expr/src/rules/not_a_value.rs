use labspec_finding::{Example, Layer, Rule, Severity};

/// An object or a function stands where a value must stand.
pub const NOT_A_VALUE: &Rule = &Rule {
    code: "not-a-value",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "an object or a function stands where a value must stand",
    why: "JavaScript makes a text of it, and a computation with it gives NaN",
    bad: Example::Expression("⟦data⟧ + 1"),
    good: Example::Expression("data.time + 1"),
};
