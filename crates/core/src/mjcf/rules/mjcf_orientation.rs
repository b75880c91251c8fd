use labspec_finding::{Example, Layer, Rule, Severity};

/// The orientation describes no rotation.
pub const ORIENTATION: &Rule = &Rule {
    code: "mjcf-orientation",
    severity: Severity::Error,
    layer: Layer::Model,
    summary: "the orientation describes no rotation",
    why: "which of the two is meant cannot be known",
    bad: Example::Model("<mujoco><worldbody><geom size='.1' axisangle='⟦0 0 0 90⟧'/></worldbody></mujoco>"),
    good: Example::Model("<mujoco><worldbody><geom size='.1' axisangle='0 0 1 90'/></worldbody></mujoco>"),
};
