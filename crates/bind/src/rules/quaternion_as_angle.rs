use labspec_finding::{Example, Layer, Rule, Severity};

/// An expression uses a component of a quaternion or of a rotation matrix as an angle.
pub const QUATERNION_AS_ANGLE: &Rule = &Rule {
    code: "quaternion-as-angle",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Program,
    summary: "an expression uses a component of a quaternion or of a rotation matrix as an angle",
    why: "the four numbers of a free or ball joint are not angles: a turn of 90 degrees has 0.707 in two of them. The same holds for `xquat`, `body_quat` and a sensor `framequat`. An element of `xmat` is a cosine",
    bad: Example::Expression("⟦data.qpos[4]⟧ * 180 / Math.PI"),
    good: Example::Expression("data.qpos[7] * 180 / Math.PI"),
};
