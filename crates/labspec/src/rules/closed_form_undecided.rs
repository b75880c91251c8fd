use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `hold` in `verify/exact.rs`.
pub const CLOSED_FORM_UNDECIDED: &Rule = &Rule {
    code: "closed-form-undecided",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Claim,
    summary: "the runs do not decide whether a trace follows its closed form",
    why: "the difference neither vanishes nor settles as the timestep shrinks; a stated tolerance decides it",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><option integrator='RK4'/><worldbody><body pos='0 0 3'><joint name='a' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/><body pos='0 0 -1'><joint name='b' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></body></worldbody></mujoco>", "setup": "data.qpos[0] = 3; data.qpos[1] = 0.1", "stopAt": 30, "plots": [{"traces": [{"label": "height", "expr": "Math.sin(data.qpos[1])"}]}], "verify": {"exact": {"height": "⟦Math.cos(3 * data.time)⟧"}}}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><geom name='floor' type='plane' size='1 1 1'/><body name='ball' pos='0 0 1'><freejoint/><geom name='ball' size='.05' mass='1'/></body></worldbody></mujoco>", "stopAt": 0.3, "plots": [{"traces": [{"label": "height", "expr": "data.qpos[2]"}]}], "verify": {"exact": {"height": {"is": "1 - 0.5 * 9.81 * data.time ** 2", "tol": 0.01}}}}"#,
    ),
};
