use labspec_finding::{Example, Layer, Rule, Severity};

/// An equality constraint does not name the objects that it connects.
pub const EQUALITY: &Rule = &Rule {
    code: "mjcf-equality",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Model,
    summary: "an equality constraint does not say what it connects",
    why: "the model does not load, so the scene stays empty",
    bad: Example::Model(
        "<mujoco><worldbody><body name='ball'><freejoint name='ball'/><geom size='.1'/></body></worldbody><equality><joint joint1='⟦ball⟧'/></equality></mujoco>",
    ),
    good: Example::Model(
        "<mujoco><worldbody><body><joint name='hinge'/><geom size='.1'/></body></worldbody><equality><joint joint1='hinge'/></equality></mujoco>",
    ),
};
