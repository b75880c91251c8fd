use labspec_finding::{Example, Layer, Rule, Severity};

/// A trace shows the same number in every run.
pub const CONSTANT_TRACE: &Rule = &Rule {
    code: "constant-trace",
    severity: Severity::Warning,
    layer: Layer::Run,
    summary: "a trace shows the same number in every run",
    why: "a curve that cannot change is often a wrong name or index: `model.qpos0` for `data.qpos`, or the world body for the moving one. The rule tries every control and another state of the scene before it reports. `refLines` draws an intended constant line",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "plots": [{"window": 1, "traces": [{"label": "height", "expr": "⟦model.qpos0[2]⟧"}]}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "plots": [{"window": 1, "traces": [{"label": "height", "expr": "data.qpos[2]"}]}]}"#,
    ),
};
