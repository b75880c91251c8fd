use labspec_finding::{Example, Layer, Rule, Severity};

/// A lab or a run that is said to break does not.
pub const DOES_NOT_BREAK: &Rule = &Rule {
    code: "does-not-break",
    severity: Severity::Error,
    layer: Layer::Run,
    summary: "a lab or a run that is said to break does not",
    why: "The author says `\"expect\": \"breaks\"`, and no run does: a student sees nothing of what the text speaks of",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "expect": "⟦breaks⟧", "readouts": [{"label": "shown", "expr": "data.qpos[2]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "readouts": [{"label": "shown", "expr": "data.qpos[2]"}]}"#,
    ),
};
