use labspec_finding::{Example, Layer, Rule, Severity};

/// The name belongs to no object.
pub const UNKNOWN_NAME: &Rule = &Rule {
    code: "mjcf-unknown-name",
    severity: Severity::Error,
    layer: Layer::Model,
    summary: "the name belongs to no object",
    why: "the model does not load: the scene stays empty",
    bad: Example::Model(
        "<mujoco><worldbody><body><joint name='hinge'/><geom size='.1'/></body></worldbody><actuator><motor joint='⟦hinhe⟧'/></actuator></mujoco>",
    ),
    good: Example::Model(
        "<mujoco><worldbody><body><joint name='hinge'/><geom size='.1'/></body></worldbody><actuator><motor joint='hinge'/></actuator></mujoco>",
    ),
};
