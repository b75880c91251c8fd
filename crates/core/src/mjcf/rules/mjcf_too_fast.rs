use labspec_finding::{Example, Layer, Rule, Severity};

/// A spring, a damper or a servo is too fast for the timestep.
pub const TOO_FAST: &Rule = &Rule {
    code: "mjcf-too-fast",
    severity: Severity::Note,
    exceptions: &[],
    layer: Layer::Model,
    summary: "a spring, a damper or a servo is too fast for the timestep",
    why: "the integrator makes its motion grow from step to step, unless something else limits it; the runs of a lab show whether it does",
    bad: Example::Model(
        "<mujoco><worldbody><body><⟦joint⟧ name='spring' type='slide' stiffness='1e7'/><geom size='.1' mass='1'/></body></worldbody></mujoco>",
    ),
    good: Example::Model(
        "<mujoco><worldbody><body><joint name='spring' type='slide' stiffness='1e3'/><geom size='.1' mass='1'/></body></worldbody></mujoco>",
    ),
};
