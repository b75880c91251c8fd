use labspec_finding::{Example, Layer, Rule, Severity};

/// A value is out of range.
pub const VALUE: &Rule = &Rule {
    code: "mjcf-value",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Model,
    summary: "a value is out of range",
    why: "the model does not load, or its results have no physical meaning",
    bad: Example::Model("<mujoco><option timestep='⟦0⟧'/></mujoco>"),
    good: Example::Model("<mujoco><option timestep='0.002'/></mujoco>"),
};
