use labspec_finding::{Example, Layer, Rule, Severity};

/// A quoted text stands nowhere that a reader sees, as a number of its own.
pub const QUOTE_NOT_FOUND: &Rule = &Rule {
    code: "quote-not-found",
    severity: Severity::Error,
    layer: Layer::Claim,
    summary: "a quoted text stands nowhere that a reader sees, as a number of its own",
    why: "The check is about a number that no reader sees",
    bad: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": 0, "explain": "After 0.3 s it is lower.",
 "verify": {"lab": "#1", "runs": {"run": {"until": 0.3}}, "measure": {"z": "final(data.qpos[2])"}, "options": ["run.z < 1", "run.z > 1"], "says": [["⟦0.56 m⟧", "run.z"]]}}"##,
    ),
    good: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": 0, "explain": "After 0.3 s it is 0.56 m high.",
 "verify": {"lab": "#1", "runs": {"run": {"until": 0.3}}, "measure": {"z": "final(data.qpos[2])"}, "options": ["run.z < 1", "run.z > 1"], "says": [["0.56 m", "run.z"]]}}"##,
    ),
};
