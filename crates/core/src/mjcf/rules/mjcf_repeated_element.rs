use labspec_finding::{Example, Layer, Rule, Severity};

/// The element may stand only once.
pub const REPEATED_ELEMENT: &Rule = &Rule {
    code: "mjcf-repeated-element",
    severity: Severity::Error,
    layer: Layer::Model,
    summary: "the element may stand only once",
    why: "which of the two is meant cannot be known",
    bad: Example::Model(
        "<mujoco><worldbody><body><inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/><⟦inertial⟧ pos='0 0 0' mass='2' diaginertia='1 1 1'/></body></worldbody></mujoco>",
    ),
    good: Example::Model(
        "<mujoco><worldbody><body><inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/></body></worldbody></mujoco>",
    ),
};
