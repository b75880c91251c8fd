use labspec_finding::{Example, Layer, Rule, Severity};

/// The element needs an attribute that is missing.
pub const MISSING_ATTRIBUTE: &Rule = &Rule {
    code: "mjcf-missing-attribute",
    severity: Severity::Error,
    layer: Layer::Model,
    summary: "the element needs an attribute that is missing",
    why: "the model does not load: the scene stays empty",
    bad: Example::Model(
        "<mujoco><worldbody><body><joint name='hinge'/><geom size='.1'/></body></worldbody><sensor><⟦jointpos⟧/></sensor></mujoco>",
    ),
    good: Example::Model(
        "<mujoco><worldbody><body><joint name='hinge'/><geom size='.1'/></body></worldbody><sensor><jointpos joint='hinge'/></sensor></mujoco>",
    ),
};
