use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `fragile_answer` in `verify/survival.rs`.
pub const ANSWER_FRAGILE: &Rule = &Rule {
    code: "answer-fragile",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Claim,
    summary: "the answer depends on the timestep or on the solver settings",
    why: "the question does not mention these settings, and other settings give another answer",
    bad: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": ⟦0⟧, "explain": "It has a weight.",
 "verify": {"lab": "#1", "runs": {"run": {"until": 0.3}}, "measure": {"z": "final(data.qpos[2])"}, "options": ["run.z < 0.556", "run.z >= 0.556"]}}"##,
    ),
    good: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": 0, "explain": "It has a weight.",
 "verify": {"lab": "#1", "runs": {"run": {"until": 0.3}}, "measure": {"z": "final(data.qpos[2])"}, "options": ["run.z < 1", "run.z > 1"]}}"##,
    ),
};
