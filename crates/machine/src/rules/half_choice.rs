use labspec_finding::{Example, Layer, Rule, Severity};

/// A conditional expression lacks one of its two values.
pub const HALF_CHOICE: &Rule = &Rule {
    code: "half-choice",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a conditional expression lacks one of its two values",
    why: "JavaScript rejects the whole text: a conditional expression is written `test ? a : b`",
    bad: Example::Expression("data.time > 1 ⟦?⟧ 2"),
    good: Example::Expression("data.time > 1 ? 2 : 3"),
};
