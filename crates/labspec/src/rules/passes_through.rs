use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `observe` in `crates/monitors/src/through.rs`.
pub const PASSES_THROUGH: &Rule = &Rule {
    code: "passes-through",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "a body passes through another one",
    why: "it moves farther in a step than the other body is thick, so no step finds a contact: a student sees bodies pass through walls",
    bad: Example::Lab(
        r#"{"xml": "⟦<mujoco><worldbody><geom name='plate' type='box' size='1 1 .0005'/><body name='ball' pos='0 0 .3'><freejoint/><geom name='ball' size='.01' mass='.1'/></body></worldbody></mujoco>⟧", "setup": "data.qvel[2] = -3", "stopAt": 0.5, "readouts": [{"label": "shown", "expr": "data.qpos[0]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='plate' type='box' size='1 1 .05'/><body name='ball' pos='0 0 .3'><freejoint/><geom name='ball' size='.01' mass='.1'/></body></worldbody></mujoco>", "setup": "data.qvel[2] = -1", "stopAt": 0.5, "readouts": [{"label": "shown", "expr": "data.qpos[0]"}]}"#,
    ),
};
