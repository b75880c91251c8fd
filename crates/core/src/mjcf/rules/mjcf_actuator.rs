use labspec_finding::{Example, Layer, Rule, Severity};

/// The parts of an actuator do not fit together, or its numbers are out of range.
pub const ACTUATOR: &Rule = &Rule {
    code: "mjcf-actuator",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Model,
    summary: "the parts of an actuator do not fit together, or its numbers are out of range",
    why: "the model does not load, so the scene stays empty",
    bad: Example::Model(
        "<mujoco><worldbody><body><joint name='hinge'/><geom size='.1'/></body></worldbody><actuator><⟦motor⟧ joint='hinge' ctrllimited='true'/></actuator></mujoco>",
    ),
    good: Example::Model(
        "<mujoco><worldbody><body><joint name='hinge'/><geom size='.1'/></body></worldbody><actuator><motor joint='hinge' ctrllimited='true' ctrlrange='-1 1'/></actuator></mujoco>",
    ),
};
