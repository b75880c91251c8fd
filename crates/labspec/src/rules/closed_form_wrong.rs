use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `finding` in `verify/exact.rs`.
pub const CLOSED_FORM_WRONG: &Rule = &Rule {
    code: "closed-form-wrong",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Claim,
    summary: "a trace does not follow its closed form",
    why: "the formula in the lesson does not describe the lab",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 0.3, "plots": [{"traces": [{"label": "height", "expr": "data.qpos[2]"}]}], "verify": {"exact": {"height": {"is": "⟦1 - 9.81 * data.time ** 2⟧", "tol": 0.01}}}}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 0.3, "plots": [{"traces": [{"label": "height", "expr": "data.qpos[2]"}]}], "verify": {"exact": {"height": {"is": "1 - 0.5 * 9.81 * data.time ** 2", "tol": 0.01}}}}"#,
    ),
};
