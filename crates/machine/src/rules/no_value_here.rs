use labspec_finding::{Example, Layer, Rule, Severity};

/// An expression uses `value` where no control provides one.
pub const NO_VALUE_HERE: &Rule = &Rule {
    code: "no-value-here",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "an expression uses `value` where no control provides one",
    why: "the name does not exist there, so JavaScript throws",
    bad: Example::Expression("⟦value⟧ * 2"),
    good: Example::Expression("data.time * 2"),
};
