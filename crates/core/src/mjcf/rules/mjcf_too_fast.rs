use labspec_finding::{Example, Layer, Rule, Severity};

/// A spring that the timestep does not follow.
pub const TOO_FAST: &Rule = &Rule {
    code: "mjcf-too-fast",
    severity: Severity::Note,
    layer: Layer::Model,
    summary: "a spring, a damper or a servo is faster than the timestep follows",
    why: "the integrator makes its motion grow from step to step, where nothing else holds it: the runs of a lab tell whether it does",
    bad: Example::Model(
        "<mujoco><worldbody><body><⟦joint⟧ name='spring' type='slide' stiffness='1e7'/><geom size='.1' mass='1'/></body></worldbody></mujoco>",
    ),
    good: Example::Model(
        "<mujoco><worldbody><body><joint name='spring' type='slide' stiffness='1e3'/><geom size='.1' mass='1'/></body></worldbody></mujoco>",
    ),
};
