use labspec_finding::{Example, Layer, Rule, Severity};

/// A hinge turns a very small inertia.
pub const TINY_INERTIA: &Rule = &Rule {
    code: "mjcf-tiny-inertia",
    severity: Severity::Note,
    exceptions: &[],
    layer: Layer::Model,
    summary: "a hinge turns a very small inertia",
    why: "the smallest torque makes it faster than any timestep can follow",
    bad: Example::Model(
        "<mujoco><worldbody><body><⟦joint⟧ name='hinge'/><geom size='.001' mass='1e-4'/></body></worldbody></mujoco>",
    ),
    good: Example::Model(
        "<mujoco><worldbody><body><joint name='hinge'/><geom size='.001' mass='1e-4' pos='.1 0 0'/></body></worldbody></mujoco>",
    ),
};
