use labspec_finding::{Example, Layer, Rule, Severity};

/// There is text where only elements belong.
pub const TEXT: &Rule = &Rule {
    code: "mjcf-text",
    severity: Severity::Warning,
    layer: Layer::Model,
    summary: "there is text where only elements belong",
    why: "nobody reads it: it may be what is left of a tag",
    bad: Example::Model("<mujoco><worldbody>⟦>⟧ <geom size='.1'/></worldbody></mujoco>"),
    good: Example::Model("<mujoco><worldbody><geom size='.1'/></worldbody></mujoco>"),
};
