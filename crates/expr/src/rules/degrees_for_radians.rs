use labspec_finding::{Example, Layer, Rule, Severity};

/// A number of degrees where radians are meant.
pub const DEGREES: &Rule = &Rule {
    code: "degrees-for-radians",
    severity: Severity::Warning,
    layer: Layer::Program,
    summary: "a number of degrees where radians are meant",
    why: "the functions of `Math`, and fields that hold angles, measure in radians",
    bad: Example::Expression("Math.sin(⟦90⟧)"),
    good: Example::Expression("Math.sin(Math.PI / 2)"),
};
