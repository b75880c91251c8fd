use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `ambiguous_unit` in `verify/quote/messages.rs`.
pub const QUOTE_UNCLEAR: &Rule = &Rule {
    code: "quote-unclear",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Claim,
    summary: "a quoted number has two readings, or none",
    why: "the checker compares nothing, because guessing the number would make the verdict a guess",
    bad: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": 0, "explain": "After 0.3 s it is 1/2 m high.",
 "verify": {"lab": "#1", "runs": {"run": {"until": 0.3}}, "measure": {"z": "final(data.qpos[2])"}, "options": ["run.z < 1", "run.z > 1"], "says": [["⟦1/2 m⟧", "run.z"]]}}"##,
    ),
    good: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": 0, "explain": "After 0.3 s it is 0.56 m high.",
 "verify": {"lab": "#1", "runs": {"run": {"until": 0.3}}, "measure": {"z": "final(data.qpos[2])"}, "options": ["run.z < 1", "run.z > 1"], "says": [["0.56 m", "run.z"]]}}"##,
    ),
};
