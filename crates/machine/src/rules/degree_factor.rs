use labspec_finding::{Example, Layer, Rule, Severity};

/// An angle is multiplied by a wrong factor.
pub const DEGREE_FACTOR: &Rule = &Rule {
    code: "degree-factor",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Program,
    summary: "an angle is multiplied by a number that is not the factor of degrees",
    why: "an angle in rad times 180/π is in degrees: with 180 alone, or with 360/π, the result is wrong",
    bad: Example::Expression("⟦data.qpos[7] * 180⟧"),
    good: Example::Expression("data.qpos[7] * 180 / Math.PI"),
};
