use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `settle` in `check/expect.rs`.
pub const DOES_NOT_BREAK: &Rule = &Rule {
    code: "does-not-break",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Run,
    summary: "a lab or a run is expected to break but does not",
    why: "the author writes `\"expect\": \"breaks\"`, but no run breaks: a student does not see what the text describes",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "expect": "⟦breaks⟧", "readouts": [{"label": "shown", "expr": "data.qpos[2]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "readouts": [{"label": "shown", "expr": "data.qpos[2]"}]}"#,
    ),
};
