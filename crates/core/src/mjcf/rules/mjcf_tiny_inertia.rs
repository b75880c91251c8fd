use labspec_finding::{Example, Layer, Rule, Severity};

/// A hinge that turns next to nothing.
pub const TINY_INERTIA: &Rule = &Rule {
    code: "mjcf-tiny-inertia",
    severity: Severity::Note,
    layer: Layer::Model,
    summary: "a hinge turns an inertia that is next to nothing",
    why: "the smallest torque makes it faster than any timestep follows",
    bad: Example::Model(
        "<mujoco><worldbody><body><⟦joint⟧ name='hinge'/><geom size='.001' mass='1e-4'/></body></worldbody></mujoco>",
    ),
    good: Example::Model(
        "<mujoco><worldbody><body><joint name='hinge'/><geom size='.001' mass='1e-4' pos='.1 0 0'/></body></worldbody></mujoco>",
    ),
};
