use labspec_finding::{Example, Layer, Rule, Severity};

/// A control changes nothing that a student can see.
pub const IDLE_CONTROL: &Rule = &Rule {
    code: "idle-control",
    severity: Severity::Warning,
    layer: Layer::Run,
    summary: "a control changes nothing that a student can see",
    why: "a student moves it, and every curve, number and position stays exactly the same: often the index is wrong, nothing reads the field, or something overwrites the value. The rule tries several values, early and late, with every other control moved too",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "controls": [{"label": "⟦friction⟧", "set": "model.geom_friction[2]", "min": 0.1, "max": 1, "value": 0.5}], "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "controls": [{"label": "gravity", "set": "model.opt.gravity[2]", "min": -20, "max": 0, "value": -10}], "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]}"#,
    ),
};
