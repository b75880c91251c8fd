use labspec_finding::{Example, Layer, Rule, Severity};

/// The data of a mesh do not form a solid.
pub const MESH: &Rule = &Rule {
    code: "mjcf-mesh",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Model,
    summary: "the data of a mesh do not form a solid",
    why: "a body needs a volume to have a mass and to make contact",
    bad: Example::Model(
        "<mujoco><asset><mesh name='m' vertex='⟦0 0 0 1 0 0 0 1 0⟧'/></asset><worldbody><geom type='mesh' mesh='m'/></worldbody></mujoco>",
    ),
    good: Example::Model(
        "<mujoco><asset><mesh name='m' vertex='0 0 0 1 0 0 0 1 0 0 0 1'/></asset><worldbody><geom type='mesh' mesh='m'/></worldbody></mujoco>",
    ),
};
