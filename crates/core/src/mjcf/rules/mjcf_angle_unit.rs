use labspec_finding::{Example, Layer, Rule, Severity};

/// An angle is written in radians where degrees are read, or in degrees where radians are read.
pub const ANGLE_UNIT: &Rule = &Rule {
    code: "mjcf-angle-unit",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Model,
    summary: "an angle is written in radians where degrees are read, or in degrees where radians are read",
    why: "angles of a model are degrees unless `compiler` has `angle='radian'`; targets of servos are always radians. The rule reports numbers that are a known angle in the other unit, such as 1.57",
    bad: Example::Model(
        "<mujoco><worldbody><body><joint range='⟦-1.57 1.57⟧'/><geom size='.1'/></body></worldbody></mujoco>",
    ),
    good: Example::Model(
        "<mujoco><worldbody><body><joint range='-90 90'/><geom size='.1'/></body></worldbody></mujoco>",
    ),
};
