use labspec_finding::{Example, Layer, Rule, Severity};

/// A value that is read before it is computed.
pub const STALE_READ: &Rule = &Rule {
    code: "stale-read",
    severity: Severity::Warning,
    layer: Layer::Program,
    summary: "statements read what follows from the state just after they have written it",
    why: "World positions, sensors, contacts and forces are computed from `qpos` and `qvel` by `mj_forward` and in a step. Between a write and that they are those of the state before",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "setup": "⟦data.qpos[2] = 0.5; ctx.start = data.xpos[5]⟧", "stopAt": 0.2, "readouts": [{"label": "starts at", "expr": "ctx.start"}, {"label": "height", "expr": "data.qpos[2]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "setup": "data.qpos[2] = 0.5; mj.mj_forward(model, data); ctx.start = data.xpos[5]", "stopAt": 0.2, "readouts": [{"label": "starts at", "expr": "ctx.start"}, {"label": "height", "expr": "data.qpos[2]"}]}"#,
    ),
};
