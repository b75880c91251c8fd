use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `chatter` in `crates/monitors/src/stress/watch.rs`.
pub const CHATTERS: &Rule = &Rule {
    code: "chatters",
    severity: Severity::Note,
    exceptions: &[],
    layer: Layer::Run,
    summary: "a contact switches on and off while nothing moves",
    why: "forces that jump from step to step come from the timestep, so a plot of them shows only noise",
    bad: Example::Lab(
        r#"{"xml": "⟦<mujoco><worldbody><geom name='floor' type='plane' size='5 5 1' solref='-160000 -800'/><body name='box' pos='0 0 .1'><freejoint/><geom name='box' type='box' size='.1 .1 .1' mass='1' solref='-160000 -800'/></body></worldbody></mujoco>⟧", "stopAt": 2, "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='5 5 1'/><body name='box' pos='0 0 .1'><freejoint/><geom name='box' type='box' size='.1 .1 .1' mass='1'/></body></worldbody></mujoco>", "stopAt": 2, "readouts": [{"label": "height (m)", "expr": "data.qpos[2]"}]}"#,
    ),
};
