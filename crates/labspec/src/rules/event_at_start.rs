use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `check_events` in `verify/event_at_start.rs`.
pub const EVENT_AT_START: &Rule = &Rule {
    code: "event-at-start",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "the event that a measure waits for happens at the first sample of every run that a claim reads",
    why: "the measure then describes the start, whatever happens in the run: a pendulum that is released \"turns round\" at 0 s, because its speed is 0 there",
    bad: Example::Quiz(
        r#"{"id": "swing", "questions": [{"kind": "numeric", "q": "When does the pendulum turn round, in s?", "answer": 0, "tol": 0.01, "verify": {"lab": {"stopAt": 3, "setup": "data.qpos[0] = 0.5", "xml": "<mujoco><worldbody><body><joint axis='0 1 0'/><geom size='.05' pos='0 0 -1'/></body></worldbody></mujoco>"}, "measure": {"t": "⟦crossing(data.qvel[0])⟧"}, "value": "t"}}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "swing", "questions": [{"kind": "numeric", "q": "When does the pendulum turn round, in s?", "answer": 1.02, "tol": 0.01, "verify": {"lab": {"stopAt": 3, "setup": "data.qpos[0] = 0.5", "xml": "<mujoco><worldbody><body><joint axis='0 1 0'/><geom size='.05' pos='0 0 -1'/></body></worldbody></mujoco>"}, "measure": {"t": "first(data.qvel[0] >= 0 && data.time > 0.1)"}, "value": "t"}}]}"#,
    ),
};
