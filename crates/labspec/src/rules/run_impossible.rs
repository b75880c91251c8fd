use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `prepare_run` in `verify/runner.rs`.
pub const RUN_IMPOSSIBLE: &Rule = &Rule {
    code: "run-impossible",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Claim,
    summary: "a run cannot be executed",
    why: "it does something that no student can do (a missing control, a value off the steps of a slider, a press after the end), or takes too many steps",
    bad: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": 0, "explain": "It has a weight.",
 "verify": {"lab": "#1", "runs": {"run": {"key": "⟦high⟧", "until": 0.3}}, "measure": {"z": "final(data.qpos[2])"}, "options": ["run.z < 1", "run.z > 1"]}}"##,
    ),
    good: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": 0, "explain": "It has a weight.",
 "verify": {"lab": "#1", "runs": {"run": {"until": 0.3}}, "measure": {"z": "final(data.qpos[2])"}, "options": ["run.z < 1", "run.z > 1"]}}"##,
    ),
};
