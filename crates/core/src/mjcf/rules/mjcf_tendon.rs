use labspec_finding::{Example, Layer, Rule, Severity};

/// The path of a tendon is incomplete, or its numbers are out of range.
pub const TENDON: &Rule = &Rule {
    code: "mjcf-tendon",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Model,
    summary: "the path of a tendon is incomplete, or its numbers are out of range",
    why: "the model does not load, so the scene stays empty",
    bad: Example::Model(
        "<mujoco><worldbody><site name='a'/></worldbody><tendon><spatial><⟦site⟧ site='a'/></spatial></tendon></mujoco>",
    ),
    good: Example::Model(
        "<mujoco><worldbody><site name='a'/><site name='b' pos='1 0 0'/></worldbody><tendon><spatial><site site='a'/><site site='b'/></spatial></tendon></mujoco>",
    ),
};
