use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `report_missing` in `verify/no_value.rs`.
pub const MEASURE_WITHOUT_VALUE: &Rule = &Rule {
    code: "measure-without-value",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Claim,
    summary: "a measure that a claim reads has no value in a run",
    why: "the event that it waits for does not happen in the run, so the claims that read it are not checked",
    bad: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": 0, "explain": "It has a weight.",
 "verify": {"lab": "#1", "runs": {"run": {"until": 0.3}}, "measure": {"t": "⟦first(contact('ball', 'floor'))⟧"}, "options": ["run.t < 2", "!(run.t < 2)"]}}"##,
    ),
    good: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": 0, "explain": "It has a weight.",
 "verify": {"lab": "#1", "runs": {"run": {"until": 1}}, "measure": {"t": "first(contact('ball', 'floor'))"}, "options": ["run.t < 2", "!(run.t < 2)"]}}"##,
    ),
};
