use labspec_finding::{Example, Layer, Rule, Severity};

/// A `solref` is shorter than two timesteps, so the engine silently makes it softer.
pub const SOFTENED: &Rule = &Rule {
    code: "mjcf-softened",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Model,
    summary: "a `solref` is shorter than two timesteps, so the engine silently makes it softer",
    why: "the number in the model has no effect: the timestep decides how soft contacts and limits are",
    bad: Example::Model("<mujoco><worldbody><geom size='.1' solref='⟦.001 1⟧'/></worldbody></mujoco>"),
    good: Example::Model("<mujoco><worldbody><geom size='.1' solref='.004 1'/></worldbody></mujoco>"),
};
