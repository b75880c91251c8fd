use labspec_finding::{Example, Layer, Rule, Severity};

/// A label names one thing of the model, and the expression reads another.
pub const LABEL_NAMES_ANOTHER: &Rule = &Rule {
    code: "label-names-another",
    severity: Severity::Warning,
    layer: Layer::Program,
    summary: "a label names one thing of the model, and its expression reads another",
    why: "Labels that were exchanged, or an index that was copied, show a student the wrong body under a name that the model has. It is told where the label is this name and nothing else but a unit, or where another label is the same but for the name",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='left'><joint name='left' type='slide'/><geom size='.05'/></body><body name='right' pos='1 0 0'><joint name='right' type='slide'/><geom size='.05'/></body></worldbody></mujoco>", "setup": "data.qvel[0] = 0.1", "readouts": [{"label": "⟦left (m)⟧", "expr": "data.qpos[1]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='left'><joint name='left' type='slide'/><geom size='.05'/></body><body name='right' pos='1 0 0'><joint name='right' type='slide'/><geom size='.05'/></body></worldbody></mujoco>", "setup": "data.qvel[0] = 0.1", "readouts": [{"label": "left (m)", "expr": "data.qpos[0]"}]}"#,
    ),
};
