use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `reads_outside_run` in `verify/claim.rs`.
pub const READ_OUTSIDE_RUN: &Rule = &Rule {
    code: "read-outside-run",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Claim,
    summary: "a claim reads the simulation without choosing a time of the run",
    why: "a run has many samples, and the claim does not say which one it means: the number would be that of the lab before the run",
    bad: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": 0, "explain": "It has a weight.",
 "verify": {"lab": "#1", "runs": {"run": {"until": 0.3}}, "options": ["⟦data.qpos[2] < 1⟧", "final(data.qpos[2]) > 1"]}}"##,
    ),
    good: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": 0, "explain": "It has a weight.",
 "verify": {"lab": "#1", "runs": {"run": {"until": 0.3}}, "options": ["final(data.qpos[2]) < 1", "final(data.qpos[2]) > 1"]}}"##,
    ),
};
