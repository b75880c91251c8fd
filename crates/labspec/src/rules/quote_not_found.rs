use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `not_found` in `verify/quote/messages.rs`.
pub const QUOTE_NOT_FOUND: &Rule = &Rule {
    code: "quote-not-found",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Claim,
    summary: "the quoted text does not appear in the rendered lesson",
    why: "the check is about a number that no reader sees",
    bad: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": 0, "explain": "After 0.3 s it is lower.",
 "verify": {"lab": "#1", "runs": {"run": {"until": 0.3}}, "measure": {"z": "final(data.qpos[2])"}, "options": ["run.z < 1", "run.z > 1"], "says": [["⟦0.56 m⟧", "run.z"]]}}"##,
    ),
    good: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": 0, "explain": "After 0.3 s it is 0.56 m high.",
 "verify": {"lab": "#1", "runs": {"run": {"until": 0.3}}, "measure": {"z": "final(data.qpos[2])"}, "options": ["run.z < 1", "run.z > 1"], "says": [["0.56 m", "run.z"]]}}"##,
    ),
};
