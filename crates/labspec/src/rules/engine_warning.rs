use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `explain_warning` in `run/diagnose.rs`.
pub const ENGINE_WARNING: &Rule = &Rule {
    code: "engine-warning",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "the engine warns while a lab runs",
    why: "a moving body has no inertia, or there are more contacts than the engine keeps: what follows is not physics, and the page shows no warning",
    bad: Example::Lab(
        r#"{"xml": "⟦<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody></mujoco>⟧", "setup": "model.dof_armature[0] = -5; mj.mj_setConst(model, data)", "readouts": [{"label": "shown", "expr": "data.qpos[0]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody></mujoco>", "setup": "model.dof_armature[0] = 5; mj.mj_setConst(model, data)", "readouts": [{"label": "shown", "expr": "data.qpos[0]"}]}"#,
    ),
};
