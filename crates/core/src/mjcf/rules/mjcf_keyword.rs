use labspec_finding::{Example, Layer, Rule, Severity};

/// The value is none of the keywords.
pub const KEYWORD: &Rule = &Rule {
    code: "mjcf-keyword",
    severity: Severity::Error,
    layer: Layer::Model,
    summary: "the value is none of the keywords",
    why: "the model does not load: the scene stays empty",
    bad: Example::Model("<mujoco><worldbody><geom type='⟦ball⟧' size='.1'/></worldbody></mujoco>"),
    good: Example::Model("<mujoco><worldbody><geom type='sphere' size='.1'/></worldbody></mujoco>"),
};
