use labspec_finding::{Example, Layer, Rule, Severity};

/// A trace never changes.
pub const CONSTANT_TRACE: &Rule = &Rule {
    code: "constant-trace",
    severity: Severity::Warning,
    layer: Layer::Run,
    summary: "a trace shows one number, whatever happens",
    why: "A curve that cannot change is often a wrong name or index: `model.qpos0` for `data.qpos`, the world's body for the one that moves. It is told when no run changes it, with every control moved, and when even another state of the scene does not. For a line that is meant there is `refLines`",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "plots": [{"window": 1, "traces": [{"label": "height", "expr": "⟦model.qpos0[2]⟧"}]}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "plots": [{"window": 1, "traces": [{"label": "height", "expr": "data.qpos[2]"}]}]}"#,
    ),
};
