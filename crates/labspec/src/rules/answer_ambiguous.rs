use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `report_ambiguous` in `verify/options.rs`.
pub const ANSWER_AMBIGUOUS: &Rule = &Rule {
    code: "answer-ambiguous",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Claim,
    summary: "more than one option is true",
    why: "a student who picks the other true option is graded as wrong",
    bad: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": ⟦0⟧, "explain": "It has a weight.",
 "verify": {"lab": "#1", "runs": {"run": {"until": 0.3}}, "measure": {"z": "final(data.qpos[2])"}, "options": ["run.z < 1", "run.z < 2"]}}"##,
    ),
    good: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": 0, "explain": "It has a weight.",
 "verify": {"lab": "#1", "runs": {"run": {"until": 0.3}}, "measure": {"z": "final(data.qpos[2])"}, "options": ["run.z < 1", "run.z > 1"]}}"##,
    ),
};
