use labspec_finding::{Example, Layer, Rule, Severity};

/// Motion leaves every sensible bound, and nobody warns.
pub const RUNS_AWAY: &Rule = &Rule {
    code: "runs-away",
    severity: Severity::Error,
    layer: Layer::Run,
    summary: "motion leaves every sensible bound, and no number is large enough for a warning",
    why: "It grows in every step, far beyond all that gravity and the start can give: a student sees something vanish from the picture, and nobody says why",
    bad: Example::Lab(
        r#"{"xml": "⟦<mujoco><option gravity='0 0 0'/><worldbody><body name='cart'><joint name='rail' type='slide'/><geom size='.1' mass='1'/></body></worldbody><actuator><motor joint='rail'/></actuator></mujoco>⟧", "stopAt": 1, "setup": "data.qvel[0] = 0.1", "controller": "data.ctrl[0] = 10 * data.qvel[0]", "readouts": [{"label": "x (m)", "expr": "data.qpos[0]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><option gravity='0 0 0'/><worldbody><body name='cart'><joint name='rail' type='slide'/><geom size='.1' mass='1'/></body></worldbody><actuator><motor joint='rail'/></actuator></mujoco>", "stopAt": 1, "setup": "data.qvel[0] = 0.1", "controller": "data.ctrl[0] = -10 * data.qvel[0]", "readouts": [{"label": "x (m)", "expr": "data.qpos[0]"}]}"#,
    ),
};
