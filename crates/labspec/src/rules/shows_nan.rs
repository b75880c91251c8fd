use labspec_finding::{Example, Layer, Rule, Severity};

/// A trace or a readout shows nan.
pub const SHOWS_NAN: &Rule = &Rule {
    code: "shows-nan",
    severity: Severity::Warning,
    layer: Layer::Run,
    summary: "a trace or a readout shows nan",
    why: "a student cannot tell whether the lab or the physics is broken. An intended gap writes `NaN` itself, or reads a variable that is stored later",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "readouts": [{"label": "shown", "expr": "⟦Math.sqrt(-1 - data.qpos[2])⟧"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "readouts": [{"label": "shown", "expr": "Math.sqrt(data.qpos[2] ** 2)"}]}"#,
    ),
};
