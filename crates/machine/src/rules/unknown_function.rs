use labspec_finding::{Example, Layer, Rule, Severity};

/// A call names an unknown function.
pub const UNKNOWN_FUNCTION: &Rule = &Rule {
    code: "unknown-function",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a call names an unknown function",
    why: "JavaScript throws",
    bad: Example::Expression("Math.⟦sine⟧(data.time)"),
    good: Example::Expression("Math.sin(data.time)"),
};
