use labspec_finding::{Example, Layer, Rule, Severity};

/// `!` negates one operand of a comparison.
pub const NEGATED_OPERAND: &Rule = &Rule {
    code: "negated-operand",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Program,
    summary: "`!` negates one operand of a comparison, not the comparison",
    why: "`!a > b` first turns `a` into true or false, and then compares that with `b`",
    bad: Example::Expression("⟦!data.qvel[2] > 0.1⟧ ? 1 : 0"),
    good: Example::Expression("!(data.qvel[2] > 0.1) ? 1 : 0"),
};
