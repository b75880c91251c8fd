use labspec_finding::{Example, Layer, Rule, Severity};

/// A mass changes and the inertia does not.
pub const MASS_ALONE: &Rule = &Rule {
    code: "mass-alone",
    severity: Severity::Note,
    layer: Layer::Program,
    summary: "a control changes the mass of a body that turns, and leaves its inertia",
    why: "the body weighs more and turns as before: no body of that shape does so",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 .5 0 -1' mass='1'/></body></worldbody></mujoco>", "stopAt": 0.5, "controls": [{"label": "mass (kg)", "apply": "⟦model.body_mass[1] = value; mj.mj_setConst(model, data)⟧", "reset": true, "min": 1, "max": 5, "value": 1}], "readouts": [{"label": "angle", "expr": "data.qpos[0]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 .5 0 -1' mass='1'/></body></worldbody></mujoco>", "stopAt": 0.5, "controls": [{"label": "gravity", "set": "model.opt.gravity[2]", "reset": true, "min": -20, "max": -1, "value": -10, "step": 1}], "readouts": [{"label": "angle", "expr": "data.qpos[0]"}]}"#,
    ),
};
