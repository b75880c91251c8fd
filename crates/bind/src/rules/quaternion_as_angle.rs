use labspec_finding::{Example, Layer, Rule, Severity};

/// An expression uses a component of a quaternion as an angle.
pub const QUATERNION_AS_ANGLE: &Rule = &Rule {
    code: "quaternion-as-angle",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Program,
    summary: "an expression uses a component of a quaternion as an angle",
    why: "the four numbers of a free or ball joint are not angles: a turn of 90 degrees has 0.707 in two of them",
    bad: Example::Expression("⟦data.qpos[4]⟧ * 180 / Math.PI"),
    good: Example::Expression("data.qpos[7] * 180 / Math.PI"),
};
