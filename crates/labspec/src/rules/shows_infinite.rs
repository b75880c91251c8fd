use labspec_finding::{Example, Layer, Rule, Severity};

/// A trace or a readout shows inf.
pub const SHOWS_INFINITE: &Rule = &Rule {
    code: "shows-infinite",
    severity: Severity::Warning,
    layer: Layer::Run,
    summary: "a trace or a readout shows inf",
    why: "the expression divides by 0",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "readouts": [{"label": "shown", "expr": "⟦1 / (data.time - data.time)⟧"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "readouts": [{"label": "shown", "expr": "1 / (data.time + 1)"}]}"#,
    ),
};
