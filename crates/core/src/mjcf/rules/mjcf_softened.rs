use labspec_finding::{Example, Layer, Rule, Severity};

/// A constraint that is made softer than it is written.
pub const SOFTENED: &Rule = &Rule {
    code: "mjcf-softened",
    severity: Severity::Warning,
    layer: Layer::Model,
    summary: "a `solref` is shorter than two timesteps, and made softer in silence",
    why: "the number in the model has no effect: contacts and limits are as soft as the timestep says",
    bad: Example::Model("<mujoco><worldbody><geom size='.1' solref='⟦.001 1⟧'/></worldbody></mujoco>"),
    good: Example::Model("<mujoco><worldbody><geom size='.1' solref='.004 1'/></worldbody></mujoco>"),
};
