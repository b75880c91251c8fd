use labspec_finding::{Example, Layer, Rule, Severity};

/// The lab breaks at twice its timestep.
pub const NEAR_ITS_LIMIT: &Rule = &Rule {
    code: "near-its-limit",
    severity: Severity::Note,
    layer: Layer::Run,
    summary: "the lab breaks at twice its timestep",
    why: "at its own timestep it works, but a slightly stiffer model or a page with longer steps breaks it",
    bad: Example::Lab(
        r#"{"xml": "⟦<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0' stiffness='8000'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -.5' mass='.2'/></body></worldbody></mujoco>⟧", "setup": "data.qpos[0] = 0.001", "stopAt": 2, "readouts": [{"label": "angle (rad)", "expr": "data.qpos[0]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0' stiffness='20'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -.5' mass='.2'/></body></worldbody></mujoco>", "setup": "data.qpos[0] = 0.001", "stopAt": 2, "readouts": [{"label": "angle (rad)", "expr": "data.qpos[0]"}]}"#,
    ),
};
