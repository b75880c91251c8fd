use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `unknown_trace` in `verify/exact.rs`.
pub const UNKNOWN_TRACE: &Rule = &Rule {
    code: "unknown-trace",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Claim,
    summary: "a closed form or a measure names a trace or a readout that the lab does not have",
    why: "the lab has no values to compare it with",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 0.3, "plots": [{"traces": [{"label": "height", "expr": "data.qpos[2]"}]}], "verify": {"exact": {"⟦heigth⟧": {"is": "1 - 0.5 * 9.81 * data.time ** 2", "tol": 0.01}}}}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 0.3, "plots": [{"traces": [{"label": "height", "expr": "data.qpos[2]"}]}], "verify": {"exact": {"height": {"is": "1 - 0.5 * 9.81 * data.time ** 2", "tol": 0.01}}}}"#,
    ),
};
