use labspec_finding::{Example, Layer, Rule, Severity};

/// A name does not belong to any object.
pub const UNKNOWN_NAME: &Rule = &Rule {
    code: "mjcf-unknown-name",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Model,
    summary: "a name does not belong to any object",
    why: "the model does not load, so the scene stays empty",
    bad: Example::Model(
        "<mujoco><worldbody><body><joint name='hinge'/><geom size='.1'/></body></worldbody><actuator><motor joint='⟦hinhe⟧'/></actuator></mujoco>",
    ),
    good: Example::Model(
        "<mujoco><worldbody><body><joint name='hinge'/><geom size='.1'/></body></worldbody><actuator><motor joint='hinge'/></actuator></mujoco>",
    ),
};
