use labspec_finding::{Example, Layer, Rule, Severity};

/// The text is not well-formed XML.
pub const XML: &Rule = &Rule {
    code: "mjcf-xml",
    severity: Severity::Error,
    layer: Layer::Model,
    summary: "the text is not well-formed XML",
    why: "nothing of the model can be read",
    bad: Example::Model("<mujoco><worldbody><geom size='.1'>⟦<⟧/worldbody></mujoco>"),
    good: Example::Model("<mujoco><worldbody><geom size='.1'/></worldbody></mujoco>"),
};
