use labspec_finding::{Example, Layer, Rule, Severity};

/// `key` names a keyframe that the model does not have.
pub const KEYFRAME_MISSING: &Rule = &Rule {
    code: "keyframe-missing",
    severity: Severity::Error,
    layer: Layer::Model,
    summary: "`key` names a keyframe that the model does not have",
    why: "The page silently starts from the default configuration",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody></mujoco>", "key": ⟦1⟧}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody><keyframe><key qpos='1'/></keyframe></mujoco>", "key": 0}"#,
    ),
};
