use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `penetration` in `crates/monitors/src/stress/watch.rs`.
pub const PRESSED_DEEP: &Rule = &Rule {
    code: "pressed-deep",
    severity: Severity::Note,
    exceptions: &[],
    layer: Layer::Run,
    summary: "bodies are pressed deep into each other at some setting of the controls",
    why: "a student who finds this setting sees bodies inside each other; the text may intend it, or it may be an accident",
    bad: Example::Lab(
        r#"{"xml": "⟦<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='cube' pos='0 0 1'><freejoint/><geom name='cube' type='box' size='.1 .1 .1' mass='1'/></body></worldbody></mujoco>⟧", "stopAt": 2, "controls": [{"label": "time constant (s)", "apply": "model.geom_solref[0] = value; model.geom_solref[2] = value", "min": 0.02, "max": 0.2, "value": 0.02, "reset": true}], "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='cube' pos='0 0 1'><freejoint/><geom name='cube' type='box' size='.1 .1 .1' mass='1'/></body></worldbody></mujoco>", "stopAt": 2, "controls": [{"label": "time constant (s)", "apply": "model.geom_solref[0] = value; model.geom_solref[2] = value", "min": 0.01, "max": 0.03, "value": 0.02, "reset": true}], "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]}"#,
    ),
};
