use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `judge` in `check/setconst/findings.rs`.
pub const GAIN_ALONE: &Rule = &Rule {
    code: "gain-alone",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "a program changes the gain of a servo but not its bias, or the bias but not the gain",
    why: "a servo reaches its target only if its bias is minus its gain: one acts on the position, the other on the target. The finding states what differs in a run with both",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><option gravity='0 0 0'/><worldbody><body name='arm'><joint name='hinge' axis='0 1 0' damping='3'/><geom type='capsule' size='.02' fromto='0 0 0 .5 0 0' mass='1'/></body></worldbody><actuator><position joint='hinge' kp='10' ctrlrange='-1 1'/></actuator></mujoco>", "stopAt": 2, "setup": "data.ctrl[0] = 0.5", "controls": [{"label": "stiffness kp (N m/rad)", "apply": "⟦model.actuator_gainprm[0] = value⟧", "reset": true, "min": 10, "max": 30, "value": 10}], "readouts": [{"label": "angle (rad)", "expr": "data.qpos[0]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><option gravity='0 0 0'/><worldbody><body name='arm'><joint name='hinge' axis='0 1 0' damping='3'/><geom type='capsule' size='.02' fromto='0 0 0 .5 0 0' mass='1'/></body></worldbody><actuator><position joint='hinge' kp='10' ctrlrange='-1 1'/></actuator></mujoco>", "stopAt": 2, "setup": "data.ctrl[0] = 0.5", "controls": [{"label": "stiffness kp (N m/rad)", "apply": "model.actuator_gainprm[0] = value; model.actuator_biasprm[1] = -value", "reset": true, "min": 10, "max": 30, "value": 10}], "readouts": [{"label": "angle (rad)", "expr": "data.qpos[0]"}]}"#,
    ),
};
