use labspec_finding::{Example, Layer, Rule, Severity};

/// A readout prints more decimals than the integration supports.
pub const TOO_MANY_DIGITS: &Rule = &Rule {
    code: "too-many-digits",
    severity: Severity::Note,
    layer: Layer::Run,
    summary: "a readout prints more decimals than the integration supports",
    why: "two or more decimals depend on the timestep: a student compares them with a formula, and takes the difference for physics",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 0.4, "readouts": [{"label": "height (m)", "expr": "⟦data.qpos[2]⟧", "digits": 6}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 0.4, "readouts": [{"label": "height (m)", "expr": "data.qpos[2]", "digits": 3}]}"#,
    ),
};
