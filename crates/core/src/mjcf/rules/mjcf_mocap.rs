use labspec_finding::{Example, Layer, Rule, Severity};

/// A mocap body is not a child of the world, or has joints.
pub const MOCAP: &Rule = &Rule {
    code: "mjcf-mocap",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Model,
    summary: "a mocap body is not a child of the world, or has joints",
    why: "the page moves a mocap body directly, and joints would move it too",
    bad: Example::Model(
        "<mujoco><worldbody><⟦body⟧ mocap='true'><freejoint/><geom size='.1'/></body></worldbody></mujoco>",
    ),
    good: Example::Model(
        "<mujoco><worldbody><body mocap='true'><geom size='.1'/></body></worldbody></mujoco>",
    ),
};
