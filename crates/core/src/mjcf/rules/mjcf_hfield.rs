use labspec_finding::{Example, Layer, Rule, Severity};

/// The data of a height field do not form a surface.
pub const HFIELD: &Rule = &Rule {
    code: "mjcf-hfield",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Model,
    summary: "the data of a height field do not form a surface",
    why: "the model does not load, so the scene stays empty",
    bad: Example::Model(
        "<mujoco><asset><hfield name='h' nrow='2' ncol='2' size='⟦1 1 0 1⟧'/></asset><worldbody><geom type='hfield' hfield='h'/></worldbody></mujoco>",
    ),
    good: Example::Model(
        "<mujoco><asset><hfield name='h' nrow='2' ncol='2' size='1 1 1 1'/></asset><worldbody><geom type='hfield' hfield='h'/></worldbody></mujoco>",
    ),
};
