use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `judge` in `check/setconst/findings.rs`.
pub const MASS_ALONE: &Rule = &Rule {
    code: "mass-alone",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "a program changes the mass of a body that turns but not its inertia",
    why: "the body weighs more but turns as before, which no body of that shape does. The finding states what differs in a run with the inertia of this mass",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><option gravity='4.905 0 -8.496'/><worldbody><geom type='plane' size='9 9 1'/><body name='ball' pos='0 0 .1'><freejoint/><geom size='.1' mass='1'/></body></worldbody></mujoco>", "stopAt": 1, "controls": [{"label": "mass (kg)", "apply": "⟦model.body_mass[1] = value; mj.mj_setConst(model, data)⟧", "reset": true, "min": 1, "max": 10, "value": 1}], "readouts": [{"label": "speed (m/s)", "expr": "data.qvel[0]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><option gravity='4.905 0 -8.496'/><worldbody><geom type='plane' size='9 9 1'/><body name='ball' pos='0 0 .1'><freejoint/><geom size='.1' mass='1'/></body></worldbody></mujoco>", "stopAt": 1, "controls": [{"label": "mass (kg)", "apply": "const f = value / model.body_mass[1]; model.body_mass[1] = value; for (let i = 3; i < 6; i++) model.body_inertia[i] *= f; mj.mj_setConst(model, data)", "reset": true, "min": 1, "max": 10, "value": 1}], "readouts": [{"label": "speed (m/s)", "expr": "data.qvel[0]"}]}"#,
    ),
};
