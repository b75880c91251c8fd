use labspec_finding::{Example, Layer, Rule, Severity};

/// A name is not defined.
pub const UNKNOWN_NAME: &Rule = &Rule {
    code: "unknown-name",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a name is not defined",
    why: "JavaScript throws",
    bad: Example::Expression("⟦dta⟧.qpos[7]"),
    good: Example::Expression("data.qpos[7]"),
};
