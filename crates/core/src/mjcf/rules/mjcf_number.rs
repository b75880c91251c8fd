use labspec_finding::{Example, Layer, Rule, Severity};

/// The value is not a finite number.
pub const NUMBER: &Rule = &Rule {
    code: "mjcf-number",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Model,
    summary: "the value is not a finite number",
    why: "the model does not load, so the scene stays empty",
    bad: Example::Model("<mujoco><worldbody><geom size='⟦0,1⟧'/></worldbody></mujoco>"),
    good: Example::Model("<mujoco><worldbody><geom size='0.1'/></worldbody></mujoco>"),
};
