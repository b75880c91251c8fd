use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `observe` in `crates/monitors/src/limits.rs`.
pub const PAST_LIMIT: &Rule = &Rule {
    code: "past-limit",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "a joint exceeds its limit by a large part of its range",
    why: "one step takes it past the limit, or something is stronger than the limit: a student sees the joint where it cannot be",
    bad: Example::Lab(
        r#"{"xml": "⟦<mujoco><worldbody><body name='arm'><joint name='hinge' axis='0 1 0' range='-45 45'/><geom type='capsule' size='.03' mass='.5' fromto='0 0 0 .4 0 0'/></body></worldbody></mujoco>⟧", "setup": "data.qvel[0] = 1000", "stopAt": 1, "readouts": [{"label": "shown", "expr": "data.qpos[0]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='arm'><joint name='hinge' axis='0 1 0' range='-45 45'/><geom type='capsule' size='.03' mass='.5' fromto='0 0 0 .4 0 0'/></body></worldbody></mujoco>", "setup": "data.qvel[0] = 10", "stopAt": 1, "readouts": [{"label": "shown", "expr": "data.qpos[0]"}]}"#,
    ),
};
