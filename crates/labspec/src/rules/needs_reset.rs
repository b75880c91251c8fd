use labspec_finding::{Example, Layer, Rule, Severity};

/// Only the setup reads the value of a control, and the control does not reset.
pub const NEEDS_RESET: &Rule = &Rule {
    code: "needs-reset",
    severity: Severity::Warning,
    layer: Layer::Run,
    summary: "only the setup reads the value of a control, and the control does not reset",
    why: "nothing happens when a student moves it: the setup runs only when the lab loads and at a reset",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody></mujoco>", "setup": "data.qpos[0] = ctx.start", "stopAt": 0.5, "controls": [{"label": "⟦start⟧", "param": "start", "min": 0, "max": 1, "value": 0.5}], "readouts": [{"label": "angle", "expr": "data.qpos[0]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody></mujoco>", "setup": "data.qpos[0] = ctx.start", "stopAt": 0.5, "controls": [{"label": "start", "param": "start", "reset": true, "min": 0, "max": 1, "value": 0.5}], "readouts": [{"label": "angle", "expr": "data.qpos[0]"}]}"#,
    ),
};
