use labspec_finding::{Example, Layer, Rule, Severity};

/// A sign is directly before the base of `**`.
pub const AMBIGUOUS_POWER: &Rule = &Rule {
    code: "ambiguous-power",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a sign is directly before the base of `**`",
    why: "JavaScript rejects it, because it has two possible values",
    bad: Example::Expression("⟦-data.qpos[7]⟧ ** 2"),
    good: Example::Expression("-(data.qpos[7] ** 2)"),
};
