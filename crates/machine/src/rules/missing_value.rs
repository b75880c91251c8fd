use labspec_finding::{Example, Layer, Rule, Severity};

/// A value is missing.
pub const MISSING_VALUE: &Rule = &Rule {
    code: "missing-value",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a value is missing",
    why: "JavaScript rejects the whole text",
    bad: Example::Expression("data.qpos[7] *⟦⟧ "),
    good: Example::Expression("data.qpos[7] * 2"),
};
