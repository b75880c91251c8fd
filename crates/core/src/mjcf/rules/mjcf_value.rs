use labspec_finding::{Example, Layer, Rule, Severity};

/// The value is out of its range.
pub const VALUE: &Rule = &Rule {
    code: "mjcf-value",
    severity: Severity::Error,
    layer: Layer::Model,
    summary: "the value is out of its range",
    why: "the model does not load, or computes what no physics means",
    bad: Example::Model("<mujoco><option timestep='⟦0⟧'/></mujoco>"),
    good: Example::Model("<mujoco><option timestep='0.002'/></mujoco>"),
};
