use labspec_finding::{Example, Layer, Rule, Severity};

/// The model is larger or more deeply nested than the limits allow.
pub const LIMIT: &Rule = &Rule {
    code: "mjcf-limit",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Model,
    summary: "the model is larger or more deeply nested than the limits allow",
    why: "limits keep the checker responsive for any input",
    bad: Example::LongModel("<mujoco><worldbody>", "<body>", 1100, ""),
    good: Example::Model("<mujoco><worldbody><body><geom size='.1'/></body></worldbody></mujoco>"),
};
