use labspec_finding::{Example, Layer, Rule, Severity};

/// Two traces of a plot are always the same curve.
pub const SAME_CURVE: &Rule = &Rule {
    code: "same-curve",
    severity: Severity::Warning,
    layer: Layer::Run,
    summary: "two traces of a plot are always the same curve",
    why: "one hides the other: often an expression was copied and not changed. The rule skips curves that agree only because of the physics; those differ when the scene starts from another state",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "plots": [{"window": 1, "traces": [{"label": "height", "expr": "data.qpos[2]"}, {"label": "depth", "expr": "⟦data.qpos[2]⟧"}]}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "plots": [{"window": 1, "traces": [{"label": "height", "expr": "data.qpos[2]"}, {"label": "sideways", "expr": "data.qpos[0]"}]}]}"#,
    ),
};
