use labspec_finding::{Example, Layer, Rule, Severity};

/// The gain of a servo changes and its bias does not.
pub const GAIN_ALONE: &Rule = &Rule {
    code: "gain-alone",
    severity: Severity::Warning,
    layer: Layer::Run,
    summary: "a program changes the gain of a servo and leaves its bias, or the other way round",
    why: "A servo pulls with its gain times the target and with its bias times where it is: only where one is minus the other does it go to its target. The lab was run with both: what differs is stated",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><option gravity='0 0 0'/><worldbody><body name='arm'><joint name='hinge' axis='0 1 0' damping='3'/><geom type='capsule' size='.02' fromto='0 0 0 .5 0 0' mass='1'/></body></worldbody><actuator><position joint='hinge' kp='10' ctrlrange='-1 1'/></actuator></mujoco>", "stopAt": 2, "setup": "data.ctrl[0] = 0.5", "controls": [{"label": "stiffness kp (N m/rad)", "apply": "⟦model.actuator_gainprm[0] = value⟧", "reset": true, "min": 10, "max": 30, "value": 10}], "readouts": [{"label": "angle (rad)", "expr": "data.qpos[0]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><option gravity='0 0 0'/><worldbody><body name='arm'><joint name='hinge' axis='0 1 0' damping='3'/><geom type='capsule' size='.02' fromto='0 0 0 .5 0 0' mass='1'/></body></worldbody><actuator><position joint='hinge' kp='10' ctrlrange='-1 1'/></actuator></mujoco>", "stopAt": 2, "setup": "data.ctrl[0] = 0.5", "controls": [{"label": "stiffness kp (N m/rad)", "apply": "model.actuator_gainprm[0] = value; model.actuator_biasprm[1] = -value", "reset": true, "min": 10, "max": 30, "value": 10}], "readouts": [{"label": "angle (rad)", "expr": "data.qpos[0]"}]}"#,
    ),
};
