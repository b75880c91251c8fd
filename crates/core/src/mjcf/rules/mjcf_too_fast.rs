use labspec_finding::{Example, Layer, Rule, Severity};

/// A spring that the timestep does not follow.
pub const TOO_FAST: &Rule = &Rule {
    code: "mjcf-too-fast",
    severity: Severity::Warning,
    layer: Layer::Model,
    summary: "a spring, a damper or a servo is faster than the timestep follows",
    why: "the integrator makes its motion grow from step to step: the scene flies apart, or trembles between limits",
    bad: Example::Model(
        "<mujoco><worldbody><body><⟦joint⟧ type='slide' stiffness='1e7'/><geom size='.1' mass='1'/></body></worldbody></mujoco>",
    ),
    good: Example::Model(
        "<mujoco><worldbody><body><joint type='slide' stiffness='1e3'/><geom size='.1' mass='1'/></body></worldbody></mujoco>",
    ),
};
