use labspec_finding::{Example, Layer, Rule, Severity};

/// The element does not belong here.
pub const MISPLACED_ELEMENT: &Rule = &Rule {
    code: "mjcf-misplaced-element",
    severity: Severity::Error,
    layer: Layer::Model,
    summary: "the element does not belong here",
    why: "the model does not load: the scene stays empty",
    bad: Example::Model("<mujoco><⟦geom⟧ size='.1'/></mujoco>"),
    good: Example::Model("<mujoco><worldbody><geom size='.1'/></worldbody></mujoco>"),
};
