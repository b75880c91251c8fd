use labspec_finding::{Example, Layer, Rule, Severity};

/// Statements write the state, then read values that are computed from the old state.
pub const STALE_READ: &Rule = &Rule {
    code: "stale-read",
    severity: Severity::Warning,
    layer: Layer::Program,
    summary: "statements write the state, then read values that are computed from the old state",
    why: "`mj_forward` and a step compute world positions, sensors, contacts and forces from `qpos` and `qvel`; after a write they still belong to the old state",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "setup": "⟦data.qpos[2] = 0.5; ctx.start = data.xpos[5]⟧", "stopAt": 0.2, "readouts": [{"label": "starts at", "expr": "ctx.start"}, {"label": "height", "expr": "data.qpos[2]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "setup": "data.qpos[2] = 0.5; mj.mj_forward(model, data); ctx.start = data.xpos[5]", "stopAt": 0.2, "readouts": [{"label": "starts at", "expr": "ctx.start"}, {"label": "height", "expr": "data.qpos[2]"}]}"#,
    ),
};
