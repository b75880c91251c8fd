use labspec_finding::{Example, Layer, Rule, Severity};

/// A closing bracket has no opening bracket.
pub const UNOPENED: &Rule = &Rule {
    code: "unopened",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a closing bracket has no opening bracket",
    why: "JavaScript rejects the whole text",
    bad: Example::Expression("data.time⟦)⟧"),
    good: Example::Expression("(data.time)"),
};
