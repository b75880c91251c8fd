use labspec_finding::{Example, Layer, Rule, Severity};

/// An element lacks a required attribute.
pub const MISSING_ATTRIBUTE: &Rule = &Rule {
    code: "mjcf-missing-attribute",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Model,
    summary: "an element lacks a required attribute",
    why: "the model does not load, so the scene stays empty",
    bad: Example::Model(
        "<mujoco><worldbody><body><joint name='hinge'/><geom size='.1'/></body></worldbody><sensor><⟦jointpos⟧/></sensor></mujoco>",
    ),
    good: Example::Model(
        "<mujoco><worldbody><body><joint name='hinge'/><geom size='.1'/></body></worldbody><sensor><jointpos joint='hinge'/></sensor></mujoco>",
    ),
};
