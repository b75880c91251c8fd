use labspec_finding::{Example, Layer, Rule, Severity};

/// An element or attribute has no effect.
pub const NO_EFFECT: &Rule = &Rule {
    code: "mjcf-no-effect",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Model,
    summary: "an element or attribute has no effect",
    why: "the author probably expects an effect that does not happen",
    bad: Example::Model("<mujoco><worldbody><geom size='.1' friction='⟦⟧'/></worldbody></mujoco>"),
    good: Example::Model("<mujoco><worldbody><geom size='.1'/></worldbody></mujoco>"),
};
