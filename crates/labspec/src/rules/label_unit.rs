use labspec_finding::{Example, Layer, Rule, Severity};

/// The unit in a label does not match its expression.
pub const LABEL_UNIT: &Rule = &Rule {
    code: "label-unit",
    severity: Severity::Warning,
    layer: Layer::Program,
    summary: "the unit in a label does not match its expression",
    why: "a student takes the number for what the label says: a speed in m/s under `mm/s` looks a thousand times too small. The dimension follows from the fields that the expression reads, through products, roots and `Math`; the rule compares only dimensions that are certain. A literal factor may carry any unit: `9.81 * data.time` may be a speed",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='left'><joint name='left' type='slide'/><geom size='.05'/></body><body name='right' pos='1 0 0'><joint name='right' type='slide'/><geom size='.05'/></body></worldbody></mujoco>", "setup": "data.qvel[0] = 0.1", "readouts": [{"label": "⟦speed (mm/s)⟧", "expr": "Math.abs(data.qvel[0])"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='left'><joint name='left' type='slide'/><geom size='.05'/></body><body name='right' pos='1 0 0'><joint name='right' type='slide'/><geom size='.05'/></body></worldbody></mujoco>", "setup": "data.qvel[0] = 0.1", "readouts": [{"label": "speed (mm/s)", "expr": "1000 * Math.abs(data.qvel[0])"}]}"#,
    ),
};
