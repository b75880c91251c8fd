use labspec_finding::{Example, Layer, Rule, Severity};

/// A mocap body must be a child of the world without joints.
pub const MOCAP: &Rule = &Rule {
    code: "mjcf-mocap",
    severity: Severity::Error,
    layer: Layer::Model,
    summary: "a mocap body must be a child of the world without joints",
    why: "it is moved by hand, and joints would move it, too",
    bad: Example::Model(
        "<mujoco><worldbody><⟦body⟧ mocap='true'><freejoint/><geom size='.1'/></body></worldbody></mujoco>",
    ),
    good: Example::Model(
        "<mujoco><worldbody><body mocap='true'><geom size='.1'/></body></worldbody></mujoco>",
    ),
};
