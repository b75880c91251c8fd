use labspec_finding::{Example, Layer, Rule, Severity};

/// A servo without limits.
pub const FREE_SERVO: &Rule = &Rule {
    code: "mjcf-free-servo",
    severity: Severity::Note,
    layer: Layer::Model,
    summary: "a position servo has limits neither of its control nor of its force",
    why: "whatever is written is followed, with as much force as it takes",
    bad: Example::Model(
        "<mujoco><worldbody><body><joint name='hinge'/><geom size='.1'/></body></worldbody><actuator><⟦position⟧ joint='hinge' kp='1'/></actuator></mujoco>",
    ),
    good: Example::Model(
        "<mujoco><worldbody><body><joint name='hinge'/><geom size='.1'/></body></worldbody><actuator><position joint='hinge' kp='1' ctrlrange='-1 1'/></actuator></mujoco>",
    ),
};
