use labspec_finding::{Example, Layer, Rule, Severity};

/// The value is not an allowed keyword.
pub const KEYWORD: &Rule = &Rule {
    code: "mjcf-keyword",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Model,
    summary: "the value is not an allowed keyword",
    why: "the model does not load, so the scene stays empty",
    bad: Example::Model("<mujoco><worldbody><geom type='⟦ball⟧' size='.1'/></worldbody></mujoco>"),
    good: Example::Model("<mujoco><worldbody><geom type='sphere' size='.1'/></worldbody></mujoco>"),
};
