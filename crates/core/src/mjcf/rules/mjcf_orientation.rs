use labspec_finding::{Example, Layer, Rule, Severity};

/// An orientation does not describe a rotation.
pub const ORIENTATION: &Rule = &Rule {
    code: "mjcf-orientation",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Model,
    summary: "an orientation does not describe a rotation",
    why: "the loader cannot compute the rotation",
    bad: Example::Model("<mujoco><worldbody><geom size='.1' axisangle='⟦0 0 0 90⟧'/></worldbody></mujoco>"),
    good: Example::Model("<mujoco><worldbody><geom size='.1' axisangle='0 0 1 90'/></worldbody></mujoco>"),
};
