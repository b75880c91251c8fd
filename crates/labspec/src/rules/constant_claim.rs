use labspec_finding::{Example, Layer, Rule, Severity};

/// A condition, a value or a number's expression is a bare constant.
pub const CONSTANT_CLAIM: &Rule = &Rule {
    code: "constant-claim",
    severity: Severity::Error,
    layer: Layer::Claim,
    summary: "a condition, a value or a number's expression is a bare constant",
    why: "It is the same whatever the simulation does, so nothing is checked by it",
    bad: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": 0, "explain": "It has a weight.",
 "verify": {"lab": "#1", "runs": {"run": {"until": 0.3}}, "measure": {"z": "final(data.qpos[2])"}, "options": ["⟦true⟧", "false"]}}"##,
    ),
    good: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": 0, "explain": "It has a weight.",
 "verify": {"lab": "#1", "runs": {"run": {"until": 0.3}}, "measure": {"z": "final(data.qpos[2])"}, "options": ["run.z < 1", "run.z > 1"]}}"##,
    ),
};
