use labspec_finding::{Example, Layer, Rule, Severity};

/// MJCF has no such element.
pub const UNKNOWN_ELEMENT: &Rule = &Rule {
    code: "mjcf-unknown-element",
    severity: Severity::Error,
    layer: Layer::Model,
    summary: "MJCF has no such element",
    why: "the model does not load: the scene stays empty",
    bad: Example::Model("<mujoco><worldbody><⟦gemo⟧ size='.1'/></worldbody></mujoco>"),
    good: Example::Model("<mujoco><worldbody><geom size='.1'/></worldbody></mujoco>"),
};
