use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `observe` in `crates/monitors/src/sunk.rs`.
pub const SINKS_IN: &Rule = &Rule {
    code: "sinks-in",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "a body stays inside another one by a large part of its size",
    why: "the contact is too soft for the load, or cannot push any harder: a student sees bodies sunk into each other instead of resting on each other",
    bad: Example::Lab(
        r#"{"xml": "⟦<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='light' pos='0 0 .1'><freejoint/><geom name='light' type='box' size='.1 .1 .1' mass='.001'/></body><body name='heavy' pos='0 0 .3'><freejoint/><geom name='heavy' type='box' size='.1 .1 .1' mass='10000'/></body></worldbody></mujoco>⟧", "stopAt": 2, "readouts": [{"label": "shown", "expr": "data.qpos[0]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='light' pos='0 0 .1'><freejoint/><geom name='light' type='box' size='.1 .1 .1' mass='1'/></body><body name='heavy' pos='0 0 .3'><freejoint/><geom name='heavy' type='box' size='.1 .1 .1' mass='10'/></body></worldbody></mujoco>", "stopAt": 2, "readouts": [{"label": "shown", "expr": "data.qpos[0]"}]}"#,
    ),
};
