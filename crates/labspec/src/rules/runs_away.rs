use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `unbounded_speed` in `crates/monitors/src/stress/runaway.rs`.
pub const RUNS_AWAY: &Rule = &Rule {
    code: "runs-away",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "the motion grows without bound, and the engine gives no warning",
    why: "it grows in every step, far beyond what gravity and the start can cause: a student sees something leave the picture, and nothing says why",
    bad: Example::Lab(
        r#"{"xml": "⟦<mujoco><option gravity='0 0 0'/><worldbody><body name='cart'><joint name='rail' type='slide'/><geom size='.1' mass='1'/></body></worldbody><actuator><motor joint='rail'/></actuator></mujoco>⟧", "stopAt": 1, "setup": "data.qvel[0] = 0.1", "controller": "data.ctrl[0] = 10 * data.qvel[0]", "readouts": [{"label": "x (m)", "expr": "data.qpos[0]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><option gravity='0 0 0'/><worldbody><body name='cart'><joint name='rail' type='slide'/><geom size='.1' mass='1'/></body></worldbody><actuator><motor joint='rail'/></actuator></mujoco>", "stopAt": 1, "setup": "data.qvel[0] = 0.1", "controller": "data.ctrl[0] = -10 * data.qvel[0]", "readouts": [{"label": "x (m)", "expr": "data.qpos[0]"}]}"#,
    ),
};
