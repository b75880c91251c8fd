use labspec_finding::{Example, Layer, Rule, Severity};

/// An element is not allowed here.
pub const MISPLACED_ELEMENT: &Rule = &Rule {
    code: "mjcf-misplaced-element",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Model,
    summary: "an element is not allowed here",
    why: "the model does not load, so the scene stays empty",
    bad: Example::Model("<mujoco><⟦geom⟧ size='.1'/></mujoco>"),
    good: Example::Model("<mujoco><worldbody><geom size='.1'/></worldbody></mujoco>"),
};
