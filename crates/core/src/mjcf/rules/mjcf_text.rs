use labspec_finding::{Example, Layer, Rule, Severity};

/// An element contains text where only elements are allowed.
pub const TEXT: &Rule = &Rule {
    code: "mjcf-text",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Model,
    summary: "an element contains text where only elements are allowed",
    why: "the loader does not read this text: it may be the rest of a broken tag",
    bad: Example::Model("<mujoco><worldbody>⟦>⟧ <geom size='.1'/></worldbody></mujoco>"),
    good: Example::Model("<mujoco><worldbody><geom size='.1'/></worldbody></mujoco>"),
};
