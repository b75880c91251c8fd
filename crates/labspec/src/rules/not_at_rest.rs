use labspec_finding::{Example, Layer, Rule, Severity};

/// A lab says that it begins at rest or in equilibrium, but its keyframe is not an equilibrium.
pub const NOT_AT_REST: &Rule = &Rule {
    code: "not-at-rest",
    severity: Severity::Note,
    layer: Layer::Run,
    summary: "a lab says that it begins at rest or in equilibrium, but its keyframe is not an equilibrium",
    why: "a student sees it move from the start, and looks for the reason in the control they changed",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody><keyframe><key qpos='.3'/></keyframe></mujoco>", "key": 0, "note": "⟦The rod starts at rest in equilibrium.⟧", "stopAt": 0.5, "readouts": [{"label": "angle", "expr": "data.qpos[0]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody><keyframe><key qpos='.3'/></keyframe></mujoco>", "key": 0, "note": "The rod is let go.", "stopAt": 0.5, "readouts": [{"label": "angle", "expr": "data.qpos[0]"}]}"#,
    ),
};
