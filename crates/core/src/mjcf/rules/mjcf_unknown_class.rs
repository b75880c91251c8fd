use labspec_finding::{Example, Layer, Rule, Severity};

/// A `class` names an unknown default class.
pub const UNKNOWN_CLASS: &Rule = &Rule {
    code: "mjcf-unknown-class",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Model,
    summary: "a `class` names an unknown default class",
    why: "the values of that class are missing",
    bad: Example::Model("<mujoco><worldbody><geom size='.1' class='⟦red⟧'/></worldbody></mujoco>"),
    good: Example::Model(
        "<mujoco><default><default class='red'><geom rgba='1 0 0 1'/></default></default><worldbody><geom size='.1' class='red'/></worldbody></mujoco>",
    ),
};
