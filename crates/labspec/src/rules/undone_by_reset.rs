use labspec_finding::{Example, Layer, Rule, Severity};

/// A button resets the data after it has changed them.
pub const UNDONE_BY_RESET: &Rule = &Rule {
    code: "undone-by-reset",
    severity: Severity::Warning,
    layer: Layer::Run,
    summary: "a button resets the data after it has changed them",
    why: "a reset restores every position, velocity and input: the changes are lost, and a student who presses the button sees the start",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 1, "controls": [{"type": "button", "label": "throw", "run": "⟦data.qvel[2] = 3; mj.mj_resetData(model, data)⟧"}], "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 1, "controls": [{"type": "button", "label": "throw", "run": "mj.mj_resetData(model, data); data.qvel[2] = 3"}], "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]}"#,
    ),
};
