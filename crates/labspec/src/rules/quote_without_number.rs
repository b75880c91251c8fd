use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `no_number` in `verify/quote/messages.rs`.
pub const QUOTE_WITHOUT_NUMBER: &Rule = &Rule {
    code: "quote-without-number",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Claim,
    summary: "a quote contains no number",
    why: "there is nothing to compare",
    bad: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": 0, "explain": "After 0.3 s it is lower.",
 "verify": {"lab": "#1", "runs": {"run": {"until": 0.3}}, "measure": {"z": "final(data.qpos[2])"}, "options": ["run.z < 1", "run.z > 1"], "says": [["⟦it is lower⟧", "run.z"]]}}"##,
    ),
    good: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": 0, "explain": "After 0.3 s it is 0.56 m high.",
 "verify": {"lab": "#1", "runs": {"run": {"until": 0.3}}, "measure": {"z": "final(data.qpos[2])"}, "options": ["run.z < 1", "run.z > 1"], "says": [["0.56 m", "run.z"]]}}"##,
    ),
};
