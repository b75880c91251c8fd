use labspec_finding::{Example, Layer, Rule, Severity};

/// A file that the model names cannot be read or must not be read.
pub const FILE: &Rule = &Rule {
    code: "mjcf-file",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Model,
    summary: "a file that the model names cannot be read or must not be read",
    why: "the page loads only the model, so the scene stays empty",
    bad: Example::Model(
        "<mujoco><asset><mesh name='m' file='⟦missing.obj⟧'/></asset><worldbody><geom type='mesh' mesh='m'/></worldbody></mujoco>",
    ),
    good: Example::Model(
        "<mujoco><asset><mesh name='m' vertex='0 0 0 1 0 0 0 1 0 0 0 1'/></asset><worldbody><geom type='mesh' mesh='m'/></worldbody></mujoco>",
    ),
};
