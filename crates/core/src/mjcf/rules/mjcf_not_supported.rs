use labspec_finding::{Example, Layer, Rule, Severity};

/// Labspec does not support this MJCF element, attribute or value yet.
pub const NOT_SUPPORTED: &Rule = &Rule {
    code: "mjcf-not-supported",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Model,
    summary: "labspec does not support this MJCF element, attribute or value yet",
    why: "without its effect the numbers would be wrong, so the model is refused",
    bad: Example::Model(
        "<mujoco><worldbody><⟦flexcomp⟧ name='f' type='grid' count='3 3 3' spacing='.1 .1 .1' mass='1'/></worldbody></mujoco>",
    ),
    good: Example::Model("<mujoco><worldbody><geom size='.1'/></worldbody></mujoco>"),
};
