use labspec_finding::{Example, Layer, Rule, Severity};

/// A range beside a flag that switches it off.
pub const RANGE_OFF: &Rule = &Rule {
    code: "mjcf-range-off",
    severity: Severity::Note,
    layer: Layer::Model,
    summary: "a range is given and switched off in one element",
    why: "the number looks as if it held",
    bad: Example::Model(
        "<mujoco><worldbody><body><joint range='⟦-1 1⟧' limited='false'/><geom size='.1'/></body></worldbody></mujoco>",
    ),
    good: Example::Model(
        "<mujoco><worldbody><body><joint range='-1 1'/><geom size='.1'/></body></worldbody></mujoco>",
    ),
};
