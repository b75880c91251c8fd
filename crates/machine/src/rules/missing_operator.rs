use labspec_finding::{Example, Layer, Rule, Severity};

/// Two values have no operator between them.
pub const MISSING_OPERATOR: &Rule = &Rule {
    code: "missing-operator",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Program,
    summary: "two values have no operator between them",
    why: "the operation is unknown: a product needs its `*`",
    bad: Example::Expression("2 ⟦data⟧.qpos[7]"),
    good: Example::Expression("2 * data.qpos[7]"),
};
