use labspec_finding::{Example, Layer, Rule, Severity};

/// What a control sets is set again by the setup or by the controller.
pub const OVERRULED: &Rule = &Rule {
    code: "overruled",
    severity: Severity::Warning,
    layer: Layer::Run,
    summary: "something else sets what a control sets",
    why: "A student reads one value beside the slider, and the lab has another: the setup has set it since, or the controller sets it again in every step",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='cart'><joint name='cart' type='slide' axis='1 0 0' damping='.5'/><geom size='.1' mass='1'/></body></worldbody><actuator><motor joint='cart'/></actuator></mujoco>", "stopAt": 0.5, "controller": "data.ctrl[0] = 1", "controls": [{"label": "push", "unit": "N", "set": "⟦data.ctrl[0]⟧", "init": true, "min": 0, "max": 2, "value": 1}], "readouts": [{"label": "place (m)", "expr": "data.qpos[0]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='cart'><joint name='cart' type='slide' axis='1 0 0' damping='.5'/><geom size='.1' mass='1'/></body></worldbody><actuator><motor joint='cart'/></actuator></mujoco>", "stopAt": 0.5, "controls": [{"label": "push", "unit": "N", "set": "data.ctrl[0]", "init": true, "min": 0, "max": 2, "value": 1}], "readouts": [{"label": "place (m)", "expr": "data.qpos[0]"}]}"#,
    ),
};
