use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `check_times` in `verify/late_time.rs`.
pub const TIME_NOT_REACHED: &Rule = &Rule {
    code: "time-not-reached",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "a measure waits for a time after the end of every run that a claim reads",
    why: "its condition holds at no sample, so the measure keeps its initial value, whatever the simulation does",
    bad: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "mcq", "q": "Where is the ball at the end?", "options": ["Below its start", "Above its start"], "answer": 0, "verify": {"lab": {"stopAt": 0.3, "xml": "<mujoco><worldbody><body pos='0 0 1'><freejoint/><geom size='.05'/></body></worldbody></mujoco>"}, "measure": {"z": "⟦max(data.time > 2 ? data.qpos[2] : 0)⟧"}, "options": ["z < 1", "z > 1"]}}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "mcq", "q": "Where is the ball at the end?", "options": ["Below its start", "Above its start"], "answer": 0, "verify": {"lab": {"stopAt": 0.3, "xml": "<mujoco><worldbody><body pos='0 0 1'><freejoint/><geom size='.05'/></body></worldbody></mujoco>"}, "measure": {"z": "max(data.time > 0.2 ? data.qpos[2] : 0)"}, "options": ["z < 1", "z > 1"]}}]}"#,
    ),
};
