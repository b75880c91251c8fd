use labspec_finding::{Example, Layer, Rule, Severity};

/// An expression asks for a random number.
pub const NOT_RANDOM: &Rule = &Rule {
    code: "not-random",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "an expression asks for a random number",
    why: "the same text must give the same numbers for every reader and every check",
    bad: Example::Expression("⟦Math.random⟧()"),
    good: Example::Expression("Math.sin(1e3 * data.time)"),
};
