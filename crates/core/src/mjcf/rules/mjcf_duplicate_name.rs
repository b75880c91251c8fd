use labspec_finding::{Example, Layer, Rule, Severity};

/// Two objects of one kind have the same name.
pub const DUPLICATE_NAME: &Rule = &Rule {
    code: "mjcf-duplicate-name",
    severity: Severity::Error,
    layer: Layer::Model,
    summary: "two objects of one kind have the same name",
    why: "which of the two is meant cannot be known",
    bad: Example::Model(
        "<mujoco><worldbody><geom name='a' size='.1'/><geom name='⟦a⟧' size='.2'/></worldbody></mujoco>",
    ),
    good: Example::Model(
        "<mujoco><worldbody><geom name='a' size='.1'/><geom name='b' size='.2'/></worldbody></mujoco>",
    ),
};
