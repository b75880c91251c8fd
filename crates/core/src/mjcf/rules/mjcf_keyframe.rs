use labspec_finding::{Example, Layer, Rule, Severity};

/// A keyframe does not fit the model.
pub const KEYFRAME: &Rule = &Rule {
    code: "mjcf-keyframe",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Model,
    summary: "a keyframe does not fit the model",
    why: "the stored state is not a state of this model",
    bad: Example::Model(
        "<mujoco><worldbody><body><joint name='hinge'/><geom size='.1'/></body></worldbody><keyframe><key qpos='⟦0 0⟧'/></keyframe></mujoco>",
    ),
    good: Example::Model(
        "<mujoco><worldbody><body><joint name='hinge'/><geom size='.1'/></body></worldbody><keyframe><key qpos='0'/></keyframe></mujoco>",
    ),
};
