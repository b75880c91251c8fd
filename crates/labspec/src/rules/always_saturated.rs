use labspec_finding::{Example, Layer, Rule, Severity};

/// An input is outside its `ctrlrange` all the time, in every run.
pub const ALWAYS_SATURATED: &Rule = &Rule {
    code: "always-saturated",
    severity: Severity::Warning,
    layer: Layer::Run,
    summary: "an input is outside its `ctrlrange` all the time, in every run",
    why: "the engine clamps the input: the actuator stays at its limit, whatever the controller computes",
    bad: Example::Lab(
        r#"{"xml": "⟦<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody><actuator><motor joint='hinge' ctrlrange='-1 1' ctrllimited='true'/></actuator></mujoco>⟧", "controller": "data.ctrl[0] = 5 + data.qpos[0]", "stopAt": 0.5, "readouts": [{"label": "angle", "expr": "data.qpos[0]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody><actuator><motor joint='hinge' ctrlrange='-1 1' ctrllimited='true'/></actuator></mujoco>", "controller": "data.ctrl[0] = 0.5 - data.qpos[0]", "stopAt": 0.5, "readouts": [{"label": "angle", "expr": "data.qpos[0]"}]}"#,
    ),
};
