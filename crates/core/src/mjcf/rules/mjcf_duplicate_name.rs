use labspec_finding::{Example, Layer, Rule, Severity};

/// Two objects of the same kind have the same name.
pub const DUPLICATE_NAME: &Rule = &Rule {
    code: "mjcf-duplicate-name",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Model,
    summary: "two objects of the same kind have the same name",
    why: "the loader cannot know which of the two is meant",
    bad: Example::Model(
        "<mujoco><worldbody><geom name='a' size='.1'/><geom name='⟦a⟧' size='.2'/></worldbody></mujoco>",
    ),
    good: Example::Model(
        "<mujoco><worldbody><geom name='a' size='.1'/><geom name='b' size='.2'/></worldbody></mujoco>",
    ),
};
