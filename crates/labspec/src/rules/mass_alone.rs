use labspec_finding::{Example, Layer, Rule, Severity};

/// A mass changes and the inertia does not.
pub const MASS_ALONE: &Rule = &Rule {
    code: "mass-alone",
    severity: Severity::Warning,
    layer: Layer::Run,
    summary: "a program changes the mass of a body that turns, and leaves its inertia",
    why: "The body weighs more and turns as before: no body of that shape does so. The lab was run with and without the inertia that this mass has: what differs is stated",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><option gravity='4.905 0 -8.496'/><worldbody><geom type='plane' size='9 9 1'/><body name='ball' pos='0 0 .1'><freejoint/><geom size='.1' mass='1'/></body></worldbody></mujoco>", "stopAt": 1, "controls": [{"label": "mass (kg)", "apply": "⟦model.body_mass[1] = value; mj.mj_setConst(model, data)⟧", "reset": true, "min": 1, "max": 10, "value": 1}], "readouts": [{"label": "speed (m/s)", "expr": "data.qvel[0]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><option gravity='4.905 0 -8.496'/><worldbody><geom type='plane' size='9 9 1'/><body name='ball' pos='0 0 .1'><freejoint/><geom size='.1' mass='1'/></body></worldbody></mujoco>", "stopAt": 1, "controls": [{"label": "mass (kg)", "apply": "const f = value / model.body_mass[1]; model.body_mass[1] = value; for (let i = 3; i < 6; i++) model.body_inertia[i] *= f; mj.mj_setConst(model, data)", "reset": true, "min": 1, "max": 10, "value": 1}], "readouts": [{"label": "speed (m/s)", "expr": "data.qvel[0]"}]}"#,
    ),
};
