use labspec_finding::{Example, Layer, Rule, Severity};

/// A keyframe puts a joint outside its range.
pub const KEY_BEYOND: &Rule = &Rule {
    code: "mjcf-key-beyond",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Model,
    summary: "a keyframe puts a joint outside its range",
    why: "the limit pushes the joint back from the first step on, so the scene does not begin at rest",
    bad: Example::Model(
        "<mujoco><compiler angle='radian'/><worldbody><body><joint range='-1 1'/><geom size='.1'/></body></worldbody><keyframe><key qpos='⟦1.5⟧'/></keyframe></mujoco>",
    ),
    good: Example::Model(
        "<mujoco><compiler angle='radian'/><worldbody><body><joint range='-1 1'/><geom size='.1'/></body></worldbody><keyframe><key qpos='0.5'/></keyframe></mujoco>",
    ),
};
