use labspec_finding::{Example, Layer, Rule, Severity};

/// The equality constraint does not say what it ties.
pub const EQUALITY: &Rule = &Rule {
    code: "mjcf-equality",
    severity: Severity::Error,
    layer: Layer::Model,
    summary: "the equality constraint does not say what it ties",
    why: "the model does not load: the scene stays empty",
    bad: Example::Model(
        "<mujoco><worldbody><body name='ball'><freejoint name='ball'/><geom size='.1'/></body></worldbody><equality><joint joint1='⟦ball⟧'/></equality></mujoco>",
    ),
    good: Example::Model(
        "<mujoco><worldbody><body><joint name='hinge'/><geom size='.1'/></body></worldbody><equality><joint joint1='hinge'/></equality></mujoco>",
    ),
};
