use labspec_finding::{Example, Layer, Rule, Severity};

/// An attribute has too many or too few numbers.
pub const COUNT: &Rule = &Rule {
    code: "mjcf-count",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Model,
    summary: "an attribute has too many or too few numbers",
    why: "the model does not load, so the scene stays empty",
    bad: Example::Model("<mujoco><worldbody><geom size='.1' pos='⟦0 0⟧'/></worldbody></mujoco>"),
    good: Example::Model("<mujoco><worldbody><geom size='.1' pos='0 0 0'/></worldbody></mujoco>"),
};
