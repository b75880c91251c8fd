use labspec_finding::{Example, Layer, Rule, Severity};

/// A readout shows the initial value of a coordinate that moves.
pub const SHOWS_THE_START: &Rule = &Rule {
    code: "shows-the-start",
    severity: Severity::Warning,
    layer: Layer::Run,
    summary: "a readout shows the initial value of a coordinate that moves",
    why: "`model.qpos0` holds the initial coordinates and never changes; `data.qpos` holds the current ones. The rule reports it if the coordinate moves in a run and the label does not mention the start",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 0.3, "readouts": [{"label": "height (m)", "expr": "⟦model.qpos0[2]⟧"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 0.3, "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}, {"label": "height at the start (m)", "expr": "model.qpos0[2]"}]}"#,
    ),
};
