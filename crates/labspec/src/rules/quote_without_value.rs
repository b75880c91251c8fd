use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `no_value` in `verify/quote/messages.rs`.
pub const QUOTE_WITHOUT_VALUE: &Rule = &Rule {
    code: "quote-without-value",
    severity: Severity::Error,
    layer: Layer::Claim,
    summary: "the expression of a quoted number has no value",
    why: "the event that it waits for never happens in the run, so nothing is compared",
    bad: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": 0, "explain": "It lands after 0.45 s.",
 "verify": {"lab": "#1", "runs": {"run": {"until": 0.3}}, "measure": {"z": "final(data.qpos[2])", "t": "first(contact('ball', 'floor'))"}, "options": ["run.z < 0.9", "run.z > 1.1"], "says": [["0.45 s", "⟦run.t⟧"]]}}"##,
    ),
    good: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": 0, "explain": "It lands after 0.44 s.",
 "verify": {"lab": "#1", "runs": {"run": {"until": 1}}, "measure": {"z": "final(data.qpos[2])", "t": "first(contact('ball', 'floor'))"}, "options": ["run.z < 0.9", "run.z > 1.1"], "says": [["0.44 s", "run.t"]]}}"##,
    ),
};
