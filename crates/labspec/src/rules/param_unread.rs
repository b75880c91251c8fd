use labspec_finding::{Example, Layer, Rule, Severity};

/// Nothing reads the variable of a `param`.
pub const PARAM_UNREAD: &Rule = &Rule {
    code: "param-unread",
    severity: Severity::Warning,
    layer: Layer::Program,
    summary: "nothing reads the variable of a `param`",
    why: "the page stores the value as `ctx.NAME`, but no expression of the lesson uses it: moving the control changes nothing",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody></mujoco>", "controls": [{"label": "push", "param": "⟦torqe⟧", "min": 0, "max": 1, "value": 0}], "controller": "data.qfrc_applied[0] = ctx.torque || 0", "readouts": [{"label": "angle", "expr": "data.qpos[0]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody></mujoco>", "controls": [{"label": "push", "param": "torque", "min": 0, "max": 1, "value": 0}], "controller": "data.qfrc_applied[0] = ctx.torque || 0", "readouts": [{"label": "angle", "expr": "data.qpos[0]"}]}"#,
    ),
};
