use labspec_finding::{Example, Layer, Rule, Severity};

/// MJCF does not define this element.
pub const UNKNOWN_ELEMENT: &Rule = &Rule {
    code: "mjcf-unknown-element",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Model,
    summary: "MJCF does not define this element",
    why: "the model does not load, so the scene stays empty",
    bad: Example::Model("<mujoco><worldbody><⟦gemo⟧ size='.1'/></worldbody></mujoco>"),
    good: Example::Model("<mujoco><worldbody><geom size='.1'/></worldbody></mujoco>"),
};
