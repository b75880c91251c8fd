use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `report_constant_claim` in `verify/grounded.rs`.
pub const CONSTANT_CLAIM: &Rule = &Rule {
    code: "constant-claim",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Claim,
    summary: "a condition, a value or the expression of a quoted number is a constant",
    why: "it gives the same result whatever the simulation does, so it checks nothing",
    bad: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": 0, "explain": "It has a weight.",
 "verify": {"lab": "#1", "runs": {"run": {"until": 0.3}}, "measure": {"z": "final(data.qpos[2])"}, "options": ["⟦true⟧", "false"]}}"##,
    ),
    good: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": 0, "explain": "It has a weight.",
 "verify": {"lab": "#1", "runs": {"run": {"until": 0.3}}, "measure": {"z": "final(data.qpos[2])"}, "options": ["run.z < 1", "run.z > 1"]}}"##,
    ),
};
