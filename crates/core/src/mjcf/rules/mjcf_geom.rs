use labspec_finding::{Example, Layer, Rule, Severity};

/// The geom lacks a size, or may not be here.
pub const GEOM: &Rule = &Rule {
    code: "mjcf-geom",
    severity: Severity::Error,
    layer: Layer::Model,
    summary: "the geom lacks a size, or may not be here",
    why: "without a size it has neither a mass nor a surface",
    bad: Example::Model("<mujoco><worldbody><geom type='box' size='⟦.1⟧'/></worldbody></mujoco>"),
    good: Example::Model("<mujoco><worldbody><geom type='box' size='.1 .1 .1'/></worldbody></mujoco>"),
};
