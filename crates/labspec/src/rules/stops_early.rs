use labspec_finding::{Example, Layer, Rule, Severity};

/// A lab stops before anything that it shows changes, or before its curves are more than a dot.
pub const STOPS_EARLY: &Rule = &Rule {
    code: "stops-early",
    severity: Severity::Warning,
    layer: Layer::Run,
    summary: "a lab stops before anything that it shows changes, or before its curves are more than a dot",
    why: "a student presses play, and almost nothing happens: one step, or a fiftieth of a plot",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": ⟦0.004⟧, "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 0.4, "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]}"#,
    ),
};
