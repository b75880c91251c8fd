use labspec_finding::{Example, Layer, Rule, Severity};

/// A moving body has no mass or an impossible inertia.
pub const INERTIA: &Rule = &Rule {
    code: "mjcf-inertia",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Model,
    summary: "a moving body has no mass or an impossible inertia",
    why: "the smallest force would move it infinitely fast",
    bad: Example::Model("<mujoco><worldbody><⟦body⟧><freejoint/></body></worldbody></mujoco>"),
    good: Example::Model(
        "<mujoco><worldbody><body><freejoint/><geom size='.1'/></body></worldbody></mujoco>",
    ),
};
