use labspec_finding::{Example, Layer, Rule, Severity};

/// A lab never reaches its `stopAt`.
pub const STOP_UNREACHED: &Rule = &Rule {
    code: "stop-unreached",
    severity: Severity::Warning,
    layer: Layer::Run,
    summary: "a lab never reaches its `stopAt`",
    why: "something resets it while it runs, and time starts again at 0: a student waits for an end that does not come",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": ⟦1⟧, "controller": "if (data.time > 0.3) { mj.mj_resetData(model, data) }", "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 1, "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]}"#,
    ),
};
