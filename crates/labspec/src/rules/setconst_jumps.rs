use labspec_finding::{Example, Layer, Rule, Severity};

/// A control calls `mj_setConst` in the middle of a run, and the scene jumps.
pub const SETCONST_JUMPS: &Rule = &Rule {
    code: "setconst-jumps",
    severity: Severity::Warning,
    layer: Layer::Run,
    summary: "a control calls `mj_setConst` in the middle of a run, and the scene jumps",
    why: "`mj_setConst` moves the coordinates back to those of the model: a falling ball returns to its start and keeps its speed",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 0.5, "controls": [{"label": "mass (kg)", "apply": "⟦model.body_mass[1] = value; mj.mj_setConst(model, data)⟧", "min": 1, "max": 50, "value": 1}], "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}, {"label": "weight (N)", "expr": "9.81 * model.body_mass[1]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 0.5, "controls": [{"label": "mass (kg)", "apply": "model.body_mass[1] = value; mj.mj_setConst(model, data)", "reset": true, "min": 1, "max": 50, "value": 1}], "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}, {"label": "weight (N)", "expr": "9.81 * model.body_mass[1]"}]}"#,
    ),
};
