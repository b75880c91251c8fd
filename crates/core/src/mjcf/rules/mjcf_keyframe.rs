use labspec_finding::{Example, Layer, Rule, Severity};

/// The keyframe does not fit the model.
pub const KEYFRAME: &Rule = &Rule {
    code: "mjcf-keyframe",
    severity: Severity::Error,
    layer: Layer::Model,
    summary: "the keyframe does not fit the model",
    why: "the state that it should hold is not one of this model",
    bad: Example::Model(
        "<mujoco><worldbody><body><joint name='hinge'/><geom size='.1'/></body></worldbody><keyframe><key qpos='⟦0 0⟧'/></keyframe></mujoco>",
    ),
    good: Example::Model(
        "<mujoco><worldbody><body><joint name='hinge'/><geom size='.1'/></body></worldbody><keyframe><key qpos='0'/></keyframe></mujoco>",
    ),
};
