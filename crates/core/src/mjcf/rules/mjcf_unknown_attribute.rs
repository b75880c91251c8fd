use labspec_finding::{Example, Layer, Rule, Severity};

/// The element has no such attribute.
pub const UNKNOWN_ATTRIBUTE: &Rule = &Rule {
    code: "mjcf-unknown-attribute",
    severity: Severity::Error,
    layer: Layer::Model,
    summary: "the element has no such attribute",
    why: "the model does not load: the scene stays empty",
    bad: Example::Model("<mujoco><worldbody><geom size='.1' ⟦frcition⟧='1'/></worldbody></mujoco>"),
    good: Example::Model("<mujoco><worldbody><geom size='.1' friction='1'/></worldbody></mujoco>"),
};
