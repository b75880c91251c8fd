use labspec_finding::{Example, Layer, Rule, Severity};

/// A controller records the time of a contact one step late.
pub const CONTACT_TIME_LATE: &Rule = &Rule {
    code: "contact-time-late",
    severity: Severity::Note,
    layer: Layer::Run,
    summary: "a controller records the time of a contact one step late",
    why: "a step finds contacts at its start, from the positions before it; when the controller sees them, `data.time` is already one timestep later",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "setup": "ctx.touch = 0", "controller": "⟦if (ctx.touch === 0 && data.ncon > 0) { ctx.touch = data.time }⟧", "stopAt": 0.6, "readouts": [{"label": "touches at (s)", "expr": "ctx.touch"}, {"label": "height (m)", "expr": "data.qpos[2]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "setup": "ctx.touch = 0", "controller": "if (ctx.touch === 0 && data.ncon > 0) { ctx.touch = data.time - model.opt.timestep }", "stopAt": 0.6, "readouts": [{"label": "touches at (s)", "expr": "ctx.touch"}, {"label": "height (m)", "expr": "data.qpos[2]"}]}"#,
    ),
};
