use labspec_finding::{Example, Layer, Rule, Severity};

/// A number is in degrees where radians are expected.
pub const DEGREES: &Rule = &Rule {
    code: "degrees-for-radians",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a number is in degrees where radians are expected",
    why: "the functions of `Math` and the fields that hold angles use radians",
    bad: Example::Expression("Math.sin(⟦90⟧)"),
    good: Example::Expression("Math.sin(Math.PI / 2)"),
};
