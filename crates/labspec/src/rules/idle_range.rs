use labspec_finding::{Example, Layer, Rule, Severity};

/// A part of the range of a slider changes nothing that a student can see.
pub const IDLE_RANGE: &Rule = &Rule {
    code: "idle-range",
    severity: Severity::Warning,
    layer: Layer::Run,
    summary: "a part of the range of a slider changes nothing that a student can see",
    why: "a student moves it, and every curve, number and position stays exactly the same: `ctrlrange`, a limit or a statement of the lab clamps the value",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "controls": [{"label": "⟦gravity⟧", "apply": "model.opt.gravity[2] = -Math.min(value, 10)", "min": 0, "max": 30, "value": 10}], "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "controls": [{"label": "gravity", "apply": "model.opt.gravity[2] = -value", "min": 0, "max": 30, "value": 10}], "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]}"#,
    ),
};
