use labspec_finding::{Example, Layer, Rule, Severity};

/// The sensor cannot measure that object.
pub const SENSOR: &Rule = &Rule {
    code: "mjcf-sensor",
    severity: Severity::Error,
    layer: Layer::Model,
    summary: "the sensor cannot measure that object",
    why: "the model does not load: the scene stays empty",
    bad: Example::Model(
        "<mujoco><worldbody><body><joint name='hinge'/><geom size='.1'/></body></worldbody><sensor><ballquat joint='⟦hinge⟧'/></sensor></mujoco>",
    ),
    good: Example::Model(
        "<mujoco><worldbody><body><joint name='hinge'/><geom size='.1'/></body></worldbody><sensor><jointpos joint='hinge'/></sensor></mujoco>",
    ),
};
