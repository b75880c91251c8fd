use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `no_value` in `verify/quote/messages.rs`.
pub const QUOTE_WITHOUT_VALUE: &Rule = &Rule {
    code: "quote-without-value",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Claim,
    summary: "the expression of a quoted number has no value",
    why: "it divides by zero, or takes a root or logarithm of a negative number, so nothing is compared",
    bad: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": 0, "explain": "It lands after 0.45 s.",
 "verify": {"lab": "#1", "runs": {"run": {"until": 1}}, "measure": {"z": "final(data.qpos[2])"}, "options": ["run.z < 0.9", "run.z > 1.1"], "says": [["0.45 s", "⟦Math.sqrt(2 * (run.z - 1) / 9.81)⟧"]]}}"##,
    ),
    good: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": 0, "explain": "It lands after 0.44 s.",
 "verify": {"lab": "#1", "runs": {"run": {"until": 1}}, "measure": {"z": "final(data.qpos[2])"}, "options": ["run.z < 0.9", "run.z > 1.1"], "says": [["0.44 s", "Math.sqrt(2 * (1 - run.z) / 9.81)"]]}}"##,
    ),
};
