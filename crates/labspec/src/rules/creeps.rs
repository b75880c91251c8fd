use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `faults` in `crates/monitors/src/stress/creep.rs`.
pub const CREEPS: &Rule = &Rule {
    code: "creeps",
    severity: Severity::Note,
    exceptions: &[],
    layer: Layer::Run,
    summary: "a body that seems to rest creeps, because friction is soft",
    why: "a student who waits sees the body slide, even if the text says that friction holds it",
    bad: Example::Lab(
        r#"{"xml": "⟦<mujoco><option gravity='4 0 -9'/><worldbody><geom name='floor' type='plane' size='5 5 1'/><body name='block' pos='0 0 .1'><freejoint/><geom name='block' type='box' size='.1 .1 .1' mass='1'/></body></worldbody></mujoco>⟧", "plots": [{"ylabel": "way (m)", "window": 5, "traces": [{"label": "block", "expr": "data.qpos[0]"}]}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><option gravity='4 0 -9' cone='elliptic' impratio='100'/><worldbody><geom name='floor' type='plane' size='5 5 1'/><body name='block' pos='0 0 .1'><freejoint/><geom name='block' type='box' size='.1 .1 .1' mass='1'/></body></worldbody></mujoco>", "plots": [{"ylabel": "way (m)", "window": 5, "traces": [{"label": "block", "expr": "data.qpos[0]"}]}]}"#,
    ),
};
