use labspec_finding::{Example, Layer, Rule, Severity};

/// Two traces are one curve.
pub const SAME_CURVE: &Rule = &Rule {
    code: "same-curve",
    severity: Severity::Warning,
    layer: Layer::Run,
    summary: "two traces of a plot lie on each other, whatever happens",
    why: "One hides the other: often a copy whose text was not changed. Curves that agree because the physics says so are not meant: these part when the scene is put into another state",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "plots": [{"window": 1, "traces": [{"label": "height", "expr": "data.qpos[2]"}, {"label": "depth", "expr": "⟦data.qpos[2]⟧"}]}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "plots": [{"window": 1, "traces": [{"label": "height", "expr": "data.qpos[2]"}, {"label": "sideways", "expr": "data.qpos[0]"}]}]}"#,
    ),
};
