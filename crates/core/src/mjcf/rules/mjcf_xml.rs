use labspec_finding::{Example, Layer, Rule, Severity};

/// The model is not well-formed XML.
pub const XML: &Rule = &Rule {
    code: "mjcf-xml",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Model,
    summary: "the model is not well-formed XML",
    why: "nothing in the model can be read",
    bad: Example::Model("<mujoco><worldbody><geom size='.1'>⟦<⟧/worldbody></mujoco>"),
    good: Example::Model("<mujoco><worldbody><geom size='.1'/></worldbody></mujoco>"),
};
