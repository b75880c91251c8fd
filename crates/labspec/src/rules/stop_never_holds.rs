use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `refuse_run_length` in `verify/unstopped.rs`.
pub const STOP_NEVER_HOLDS: &Rule = &Rule {
    code: "stop-never-holds",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Claim,
    summary: "a number is the end time of a run that never reaches its `stop`",
    why: "the run ends at its `until`, before the event, so its end time is a setting of the run, not a result of the simulation",
    bad: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": 0, "explain": "After 0.30 s it is near the floor.",
 "verify": {"lab": "#1", "runs": {"run": {"stop": "data.qpos[2] < 0.1", "until": 0.3}}, "measure": {"t": "final(data.time)", "z": "final(data.qpos[2])"}, "options": ["run.z < 1", "run.z > 1"], "says": [["0.30 s", "⟦run.t⟧"]]}}"##,
    ),
    good: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": 0, "explain": "After 0.43 s it is near the floor.",
 "verify": {"lab": "#1", "runs": {"run": {"stop": "data.qpos[2] < 0.1", "until": 1}}, "measure": {"t": "final(data.time)", "z": "final(data.qpos[2])"}, "options": ["run.z < 1", "run.z > 1"], "says": [["0.43 s", "run.t"]]}}"##,
    ),
};
