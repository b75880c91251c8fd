use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `explain_warning` in `run/diagnose.rs`.
pub const SIMULATION_DIVERGES: &Rule = &Rule {
    code: "simulation-diverges",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "the simulation meets a value that is NaN, infinite or above 1e10",
    why: "MuJoCo resets the data and continues from time 0: a student sees the scene jump back without an explanation",
    bad: Example::Lab(
        r#"{"xml": "⟦<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody></mujoco>⟧", "controller": "data.qfrc_applied[0] = 1e5 * data.qpos[0] + 1", "readouts": [{"label": "shown", "expr": "data.qpos[0]"}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody></mujoco>", "controller": "data.qfrc_applied[0] = 1", "readouts": [{"label": "shown", "expr": "data.qpos[0]"}]}"#,
    ),
};
