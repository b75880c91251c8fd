use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `of_timestep` in `verify/quote/messages.rs`.
pub const QUOTE_OF_TIMESTEP: &Rule = &Rule {
    code: "quote-of-timestep",
    severity: Severity::Note,
    exceptions: &[],
    layer: Layer::Claim,
    summary: "the digits of a quoted number change at half the timestep",
    why: "the number is right for this timestep only; a reader with another timestep finds another number",
    bad: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": 0, "explain": "After 0.3 s it is ⟦0.5556 m⟧ high.",
 "verify": {"lab": "#1", "runs": {"run": {"until": 0.3}}, "measure": {"z": "final(data.qpos[2])"}, "options": ["run.z < 1", "run.z > 1"], "says": [["0.5556 m", "run.z"]]}}"##,
    ),
    good: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": 0, "explain": "After 0.3 s it is 0.56 m high.",
 "verify": {"lab": "#1", "runs": {"run": {"until": 0.3}}, "measure": {"z": "final(data.qpos[2])"}, "options": ["run.z < 1", "run.z > 1"], "says": [["0.56 m", "run.z"]]}}"##,
    ),
};
