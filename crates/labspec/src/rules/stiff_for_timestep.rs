use labspec_finding::{Example, Layer, Rule, Severity};

/// A servo, a spring or a contact is too stiff for the timestep.
pub const STIFF_FOR_TIMESTEP: &Rule = &Rule {
    code: "stiff-for-timestep",
    severity: Severity::Warning,
    layer: Layer::Run,
    summary: "a servo, a spring or a contact is too stiff for the timestep",
    why: "every step overshoots more than the one before, and MuJoCo gives no warning until a number exceeds 1e10",
    bad: Example::Lab(
        r#"{"xml": "⟦<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0' stiffness='1e6'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody></mujoco>⟧", "setup": "data.qpos[0] = 0.001", "stopAt": 0.004, "readouts": [{"label": "shown", "expr": "data.qpos[0]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0' stiffness='10'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody></mujoco>", "setup": "data.qpos[0] = 0.001", "stopAt": 0.004, "readouts": [{"label": "shown", "expr": "data.qpos[0]"}]}"#,
    ),
};
