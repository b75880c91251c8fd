use labspec_finding::{Example, Layer, Rule, Severity};

/// A condition is always true or always false.
pub const CONSTANT_CONDITION: &Rule = &Rule {
    code: "constant-condition",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Program,
    summary: "a condition is always true or always false",
    why: "one branch is never executed: the condition does not test what was meant",
    bad: Example::Statements("if (⟦data.qpos[2] > 1 && data.qpos[2] < -1⟧) ctx.far = 1"),
    good: Example::Statements("if (data.qpos[2] > 1 || data.qpos[2] < -1) ctx.far = 1"),
};
