use labspec_finding::{Example, Layer, Rule, Severity};

/// A trace is outside its plot most of the time, in every run.
pub const OUTSIDE_PLOT: &Rule = &Rule {
    code: "outside-plot",
    severity: Severity::Warning,
    layer: Layer::Run,
    summary: "a trace is outside its plot most of the time, in every run",
    why: "`ymin` and `ymax` are the ends of the axis: the page does not draw what is above or below",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "plots": [{"window": 1, "ymin": 0, "ymax": 1.1, "traces": [{"label": "height (mm)", "expr": "⟦1000 * data.qpos[2]⟧"}]}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "plots": [{"window": 1, "ymin": 0, "ymax": 1.1, "traces": [{"label": "height (m)", "expr": "data.qpos[2]"}]}]}"#,
    ),
};
