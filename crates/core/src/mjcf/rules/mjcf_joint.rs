use labspec_finding::{Example, Layer, Rule, Severity};

/// The joints of a body do not fit together.
pub const JOINT: &Rule = &Rule {
    code: "mjcf-joint",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Model,
    summary: "the joints of a body do not fit together",
    why: "the model does not load, so the scene stays empty",
    bad: Example::Model(
        "<mujoco><worldbody><body><freejoint/><⟦joint⟧/><geom size='.1'/></body></worldbody></mujoco>",
    ),
    good: Example::Model(
        "<mujoco><worldbody><body><freejoint/><geom size='.1'/></body></worldbody></mujoco>",
    ),
};
