use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `wrong` in `verify/quote/messages.rs`.
pub const QUOTE_WRONG: &Rule = &Rule {
    code: "quote-wrong",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Claim,
    summary: "a number quoted in the text differs from the simulation",
    why: "a reader who measures it finds another number",
    bad: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": 0, "explain": "After 0.3 s it is ⟦0.60 m⟧ high.",
 "verify": {"lab": "#1", "runs": {"run": {"until": 0.3}}, "measure": {"z": "final(data.qpos[2])"}, "options": ["run.z < 1", "run.z > 1"], "says": [["0.60 m", "run.z"]]}}"##,
    ),
    good: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": 0, "explain": "After 0.3 s it is 0.56 m high.",
 "verify": {"lab": "#1", "runs": {"run": {"until": 0.3}}, "measure": {"z": "final(data.qpos[2])"}, "options": ["run.z < 1", "run.z > 1"], "says": [["0.56 m", "run.z"]]}}"##,
    ),
};
