use labspec_finding::{Example, Layer, Rule, Severity};

/// A bracket closes nothing.
pub const UNOPENED: &Rule = &Rule {
    code: "unopened",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "a bracket closes nothing",
    why: "JavaScript refuses the whole text",
    bad: Example::Expression("data.time⟦)⟧"),
    good: Example::Expression("(data.time)"),
};
