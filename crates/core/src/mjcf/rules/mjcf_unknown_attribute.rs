use labspec_finding::{Example, Layer, Rule, Severity};

/// An element has an attribute that MJCF does not define.
pub const UNKNOWN_ATTRIBUTE: &Rule = &Rule {
    code: "mjcf-unknown-attribute",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Model,
    summary: "an element has an attribute that MJCF does not define",
    why: "the model does not load, so the scene stays empty",
    bad: Example::Model("<mujoco><worldbody><geom size='.1' ⟦frcition⟧='1'/></worldbody></mujoco>"),
    good: Example::Model("<mujoco><worldbody><geom size='.1' friction='1'/></worldbody></mujoco>"),
};
