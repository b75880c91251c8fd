use labspec_finding::{Example, Layer, Rule, Severity};

/// A body begins deep inside another one.
pub const STARTS_INSIDE: &Rule = &Rule {
    code: "starts-inside",
    severity: Severity::Warning,
    layer: Layer::Run,
    summary: "a body begins deep inside another one",
    why: "the contact throws it out in the first steps: what a student sees at the start is not physics",
    bad: Example::Lab(
        r#"{"xml": "⟦<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 0.02'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>⟧", "stopAt": 0.5, "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 0.05'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 0.5, "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]}"#,
    ),
};
