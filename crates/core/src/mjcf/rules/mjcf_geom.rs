use labspec_finding::{Example, Layer, Rule, Severity};

/// A geom has no size, or is not allowed here.
pub const GEOM: &Rule = &Rule {
    code: "mjcf-geom",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Model,
    summary: "a geom has no size, or is not allowed here",
    why: "without a size it has no mass and no surface",
    bad: Example::Model("<mujoco><worldbody><geom type='box' size='⟦.1⟧'/></worldbody></mujoco>"),
    good: Example::Model("<mujoco><worldbody><geom type='box' size='.1 .1 .1'/></worldbody></mujoco>"),
};
