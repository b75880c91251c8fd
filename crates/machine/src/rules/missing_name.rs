use labspec_finding::{Example, Layer, Rule, Severity};

/// A name or a key is missing.
pub const MISSING_NAME: &Rule = &Rule {
    code: "missing-name",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a name or a key is missing",
    why: "JavaScript rejects the whole text",
    bad: Example::Expression("data.⟦⟧"),
    good: Example::Expression("data.time"),
};
