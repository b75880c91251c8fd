use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `observe` in `crates/monitors/src/growth.rs`.
pub const DAMPER_PUSHES: &Rule = &Rule {
    code: "damper-pushes",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "negative damping feeds energy into the scene without end",
    why: "the faster a part moves, the harder the damper pushes it: a student sees a swing that grows forever without a motor",
    bad: Example::Lab(
        r#"{"xml": "⟦<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0' damping='-.05'/><geom type='capsule' size='.02' mass='.5' fromto='0 0 0 .4 0 0'/></body></worldbody></mujoco>⟧", "stopAt": 6, "readouts": [{"label": "shown", "expr": "data.qpos[0]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0' damping='.05'/><geom type='capsule' size='.02' mass='.5' fromto='0 0 0 .4 0 0'/></body></worldbody></mujoco>", "stopAt": 6, "readouts": [{"label": "shown", "expr": "data.qpos[0]"}]}"#,
    ),
};
