use labspec_finding::{Example, Layer, Rule, Severity};

/// A sensor cannot measure the named object.
pub const SENSOR: &Rule = &Rule {
    code: "mjcf-sensor",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Model,
    summary: "a sensor cannot measure the named object",
    why: "the model does not load, so the scene stays empty",
    bad: Example::Model(
        "<mujoco><worldbody><body><joint name='hinge'/><geom size='.1'/></body></worldbody><sensor><ballquat joint='⟦hinge⟧'/></sensor></mujoco>",
    ),
    good: Example::Model(
        "<mujoco><worldbody><body><joint name='hinge'/><geom size='.1'/></body></worldbody><sensor><jointpos joint='hinge'/></sensor></mujoco>",
    ),
};
