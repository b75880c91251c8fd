use labspec_finding::{Example, Layer, Rule, Severity};

/// An element that may appear only once is repeated.
pub const REPEATED_ELEMENT: &Rule = &Rule {
    code: "mjcf-repeated-element",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Model,
    summary: "an element that may appear only once is repeated",
    why: "the loader cannot know which of the two is meant",
    bad: Example::Model(
        "<mujoco><worldbody><body><inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/><⟦inertial⟧ pos='0 0 0' mass='2' diaginertia='1 1 1'/></body></worldbody></mujoco>",
    ),
    good: Example::Model(
        "<mujoco><worldbody><body><inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/></body></worldbody></mujoco>",
    ),
};
