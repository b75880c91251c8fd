use labspec_finding::{Example, Layer, Rule, Severity};

/// An element gives a range and switches it off.
pub const RANGE_OFF: &Rule = &Rule {
    code: "mjcf-range-off",
    severity: Severity::Note,
    exceptions: &[],
    layer: Layer::Model,
    summary: "an element gives a range and switches it off",
    why: "a reader believes that the range applies",
    bad: Example::Model(
        "<mujoco><worldbody><body><joint range='⟦-1 1⟧' limited='false'/><geom size='.1'/></body></worldbody></mujoco>",
    ),
    good: Example::Model(
        "<mujoco><worldbody><body><joint range='-1 1'/><geom size='.1'/></body></worldbody></mujoco>",
    ),
};
