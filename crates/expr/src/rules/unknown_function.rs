use labspec_finding::{Example, Layer, Rule, Severity};

/// There is no function of this name.
pub const UNKNOWN_FUNCTION: &Rule = &Rule {
    code: "unknown-function",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "there is no function of this name",
    why: "JavaScript throws there",
    bad: Example::Expression("Math.⟦sine⟧(data.time)"),
    good: Example::Expression("Math.sin(data.time)"),
};
