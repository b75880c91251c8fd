use labspec_finding::{Example, Layer, Rule, Severity};

/// A label names one object of the model, but its expression reads another.
pub const LABEL_NAMES_ANOTHER: &Rule = &Rule {
    code: "label-names-another",
    severity: Severity::Warning,
    layer: Layer::Program,
    summary: "a label names one object of the model, but its expression reads another",
    why: "exchanged labels or a copied index show a student the value of the wrong body. The rule reports a label that is just the name and a unit, or that differs from another label only in the name",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='left'><joint name='left' type='slide'/><geom size='.05'/></body><body name='right' pos='1 0 0'><joint name='right' type='slide'/><geom size='.05'/></body></worldbody></mujoco>", "setup": "data.qvel[0] = 0.1", "readouts": [{"label": "⟦left (m)⟧", "expr": "data.qpos[1]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='left'><joint name='left' type='slide'/><geom size='.05'/></body><body name='right' pos='1 0 0'><joint name='right' type='slide'/><geom size='.05'/></body></worldbody></mujoco>", "setup": "data.qvel[0] = 0.1", "readouts": [{"label": "left (m)", "expr": "data.qpos[0]"}]}"#,
    ),
};
