use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `refute` in `verify/options.rs`.
pub const ANSWER_REFUTED: &Rule = &Rule {
    code: "answer-refuted",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Claim,
    summary: "the simulation refutes the keyed answer",
    why: "a student who predicts the simulation correctly is graded as wrong",
    bad: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": ⟦1⟧, "explain": "It has a weight.",
 "verify": {"lab": "#1", "runs": {"run": {"until": 0.3}}, "measure": {"z": "final(data.qpos[2])"}, "options": ["run.z < 1", "run.z > 1"]}}"##,
    ),
    good: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": 0, "explain": "It has a weight.",
 "verify": {"lab": "#1", "runs": {"run": {"until": 0.3}}, "measure": {"z": "final(data.qpos[2])"}, "options": ["run.z < 1", "run.z > 1"]}}"##,
    ),
};
