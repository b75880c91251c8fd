use labspec_finding::{Example, Layer, Rule, Severity};

/// The note says that a control restarts the lab, but it does not.
pub const GOES_ON: &Rule = &Rule {
    code: "goes-on",
    severity: Severity::Warning,
    layer: Layer::Run,
    summary: "the note says that a control restarts the lab, but it does not",
    why: "the run continues from its current state with the new value: a student who wants to compare two runs sees only the end of one",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 0.4, "controls": [{"label": "⟦gravity⟧", "unit": "m/s^2", "set": "model.opt.gravity[2]", "min": -20, "max": 0, "value": -9.8, "step": 0.2}], "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}], "note": "Changing gravity starts the fall again."}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 0.4, "controls": [{"label": "gravity", "unit": "m/s^2", "set": "model.opt.gravity[2]", "min": -20, "max": 0, "value": -9.8, "step": 0.2, "reset": true}], "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}], "note": "Changing gravity starts the fall again."}"#,
    ),
};
