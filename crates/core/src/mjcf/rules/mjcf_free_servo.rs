use labspec_finding::{Example, Layer, Rule, Severity};

/// A position servo has no limit on its control or its force.
pub const FREE_SERVO: &Rule = &Rule {
    code: "mjcf-free-servo",
    severity: Severity::Note,
    exceptions: &[],
    layer: Layer::Model,
    summary: "a position servo has no limit on its control or its force",
    why: "it follows any target with as much force as it takes",
    bad: Example::Model(
        "<mujoco><worldbody><body><joint name='hinge'/><geom size='.1'/></body></worldbody><actuator><⟦position⟧ joint='hinge' kp='1'/></actuator></mujoco>",
    ),
    good: Example::Model(
        "<mujoco><worldbody><body><joint name='hinge'/><geom size='.1'/></body></worldbody><actuator><position joint='hinge' kp='1' ctrlrange='-1 1'/></actuator></mujoco>",
    ),
};
