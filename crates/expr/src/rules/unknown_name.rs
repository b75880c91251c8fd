use labspec_finding::{Example, Layer, Rule, Severity};

/// A name that nothing defines.
pub const UNKNOWN_NAME: &Rule = &Rule {
    code: "unknown-name",
    severity: Severity::Error,
    layer: Layer::Program,
    summary: "a name that nothing defines",
    why: "JavaScript throws there",
    bad: Example::Expression("⟦dta⟧.qpos[7]"),
    good: Example::Expression("data.qpos[7]"),
};
