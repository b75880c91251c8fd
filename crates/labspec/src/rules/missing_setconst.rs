use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `judge` in `check/setconst/findings.rs`.
pub const MISSING_SETCONST: &Rule = &Rule {
    code: "missing-setconst",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "a mass or an inertia changes without `mj_setConst`",
    why: "the constants that follow from it keep their old values, so contacts are as soft as for the old mass. The finding states what differs in a run with `mj_setConst`",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 1, "controls": [{"label": "mass (kg)", "set": "⟦model.body_mass[1]⟧", "min": 1, "max": 50, "value": 1}], "readouts": [{"label": "shown", "expr": "data.qpos[2]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 1, "controls": [{"label": "mass (kg)", "apply": "const f = value / model.body_mass[1]; model.body_mass[1] = value; for (let i = 3; i < 6; i++) model.body_inertia[i] *= f; mj.mj_setConst(model, data)", "reset": true, "min": 1, "max": 50, "value": 1}], "readouts": [{"label": "shown", "expr": "data.qpos[2]"}]}"#,
    ),
};
