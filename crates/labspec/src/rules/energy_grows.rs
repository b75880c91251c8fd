use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `observe` in `crates/monitors/src/growth.rs`.
pub const ENERGY_GROWS: &Rule = &Rule {
    code: "energy-grows",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "the simulation gains energy without a source",
    why: "the steps create the energy, not the physics: a student sees things leap or swing ever wider, and MuJoCo gives no warning",
    bad: Example::Lab(
        r#"{"xml": "⟦<mujoco><option timestep='0.1'/><worldbody><body name='rod'><joint name='hinge' axis='0 1 0' stiffness='200'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody></mujoco>⟧", "setup": "data.qpos[0] = 1", "stopAt": 20, "readouts": [{"label": "shown", "expr": "data.qpos[0]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody></mujoco>", "setup": "data.qpos[0] = 1", "readouts": [{"label": "shown", "expr": "data.qpos[0]"}]}"#,
    ),
};
