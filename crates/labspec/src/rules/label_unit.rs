use labspec_finding::{Example, Layer, Rule, Severity};

/// The unit in a label contradicts the expression.
pub const LABEL_UNIT: &Rule = &Rule {
    code: "label-unit",
    severity: Severity::Warning,
    layer: Layer::Program,
    summary: "the unit in a label is not that of the numbers",
    why: "A student takes the number for what the label says: a speed in m/s under `mm/s` is a thousand times too small, an angle in radians under `deg` is another angle. The dimension of an expression follows from the fields that it reads, through products, roots and `Math`; it is compared only where it is certain. Numbers of the text may stand for anything: `9.81 * data.time` may be a speed",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='left'><joint name='left' type='slide'/><geom size='.05'/></body><body name='right' pos='1 0 0'><joint name='right' type='slide'/><geom size='.05'/></body></worldbody></mujoco>", "setup": "data.qvel[0] = 0.1", "readouts": [{"label": "⟦speed (mm/s)⟧", "expr": "Math.abs(data.qvel[0])"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='left'><joint name='left' type='slide'/><geom size='.05'/></body><body name='right' pos='1 0 0'><joint name='right' type='slide'/><geom size='.05'/></body></worldbody></mujoco>", "setup": "data.qvel[0] = 0.1", "readouts": [{"label": "speed (mm/s)", "expr": "1000 * Math.abs(data.qvel[0])"}]}"#,
    ),
};
