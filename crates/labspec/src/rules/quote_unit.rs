use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `other_unit` in `verify/quote/messages.rs`.
pub const QUOTE_UNIT: &Rule = &Rule {
    code: "quote-unit",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Claim,
    summary: "a quoted number and its expression differ by a power of ten",
    why: "the text uses another unit than the expression, so the two cannot be compared",
    bad: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": 0, "explain": "After 0.3 s it is 556 mm high.",
 "verify": {"lab": "#1", "runs": {"run": {"until": 0.3}}, "measure": {"z": "final(data.qpos[2])"}, "options": ["run.z < 1", "run.z > 1"], "says": [["556 mm", "⟦run.z⟧"]]}}"##,
    ),
    good: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": 0, "explain": "After 0.3 s it is 56 cm high.",
 "verify": {"lab": "#1", "runs": {"run": {"until": 0.3}}, "measure": {"z": "final(data.qpos[2])"}, "options": ["run.z < 1", "run.z > 1"], "says": [["56 cm", "100 * run.z"]]}}"##,
    ),
};
