use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `action` in `bind/compile.rs`.
pub const VALUE_UNUSED: &Rule = &Rule {
    code: "value-unused",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Program,
    summary: "the statements of a control never use `value`",
    why: "moving the control changes nothing",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody></mujoco>", "controls": [{"label": "push", "apply": "⟦data.qvel[0] = 1⟧", "min": 0, "max": 1, "value": 0}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody></mujoco>", "controls": [{"label": "push", "apply": "data.qvel[0] = value", "min": 0, "max": 1, "value": 0, "init": true}]}"#,
    ),
};
