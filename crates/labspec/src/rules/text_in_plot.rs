use labspec_finding::{Example, Layer, Rule, Severity};

/// A trace of a plot is a string.
pub const TEXT_IN_PLOT: &Rule = &Rule {
    code: "text-in-plot",
    severity: Severity::Warning,
    layer: Layer::Run,
    summary: "a trace of a plot is a string",
    why: "a plot draws numbers: the curve is missing, or shows what the page makes of the string",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "plots": [{"traces": [{"label": "height", "expr": "⟦data.qpos[2].toFixed(2)⟧"}]}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "plots": [{"traces": [{"label": "height", "expr": "data.qpos[2]"}]}]}"#,
    ),
};
