use labspec_finding::{Example, Layer, Rule, Severity};

/// What is written there has no effect.
pub const NO_EFFECT: &Rule = &Rule {
    code: "mjcf-no-effect",
    severity: Severity::Warning,
    layer: Layer::Model,
    summary: "what is written there has no effect",
    why: "its author probably wants something that does not happen",
    bad: Example::Model("<mujoco><worldbody><geom size='.1' friction='⟦⟧'/></worldbody></mujoco>"),
    good: Example::Model("<mujoco><worldbody><geom size='.1'/></worldbody></mujoco>"),
};
