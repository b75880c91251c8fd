use labspec_finding::{Example, Layer, Rule, Severity};

/// The setup or the controller overwrites what a control sets.
pub const OVERRULED: &Rule = &Rule {
    code: "overruled",
    severity: Severity::Warning,
    layer: Layer::Run,
    summary: "the setup or the controller overwrites what a control sets",
    why: "a student reads one value beside the slider, but the lab uses another: the setup overwrites it once, or the controller in every step",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='cart'><joint name='cart' type='slide' axis='1 0 0' damping='.5'/><geom size='.1' mass='1'/></body></worldbody><actuator><motor joint='cart'/></actuator></mujoco>", "stopAt": 0.5, "controller": "data.ctrl[0] = 1", "controls": [{"label": "push", "unit": "N", "set": "⟦data.ctrl[0]⟧", "init": true, "min": 0, "max": 2, "value": 1}], "readouts": [{"label": "place (m)", "expr": "data.qpos[0]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='cart'><joint name='cart' type='slide' axis='1 0 0' damping='.5'/><geom size='.1' mass='1'/></body></worldbody><actuator><motor joint='cart'/></actuator></mujoco>", "stopAt": 0.5, "controls": [{"label": "push", "unit": "N", "set": "data.ctrl[0]", "init": true, "min": 0, "max": 2, "value": 1}], "readouts": [{"label": "place (m)", "expr": "data.qpos[0]"}]}"#,
    ),
};
