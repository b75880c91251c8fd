use labspec_finding::{Example, Layer, Rule, Severity};

/// A reset discards what a control sets in the data.
pub const LOST_AT_RESET: &Rule = &Rule {
    code: "lost-at-reset",
    severity: Severity::Warning,
    layer: Layer::Program,
    summary: "a reset discards what a control sets in the data",
    why: "the control still displays its value, but the simulation no longer uses it; `\"init\": true` applies it again",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody></mujoco>", "controls": [{"label": "angle", "set": "⟦data.qpos[0]⟧", "min": 0, "max": 1, "value": 0.5}], "readouts": [{"label": "shown", "expr": "data.qpos[0]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody></mujoco>", "controls": [{"label": "angle", "set": "data.qpos[0]", "min": 0, "max": 1, "value": 0.5, "init": true}], "readouts": [{"label": "shown", "expr": "data.qpos[0]"}]}"#,
    ),
};
