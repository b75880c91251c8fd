use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `report_undecided` in `verify/grounded.rs`.
pub const COMPARES_NAN: &Rule = &Rule {
    code: "compares-nan",
    severity: Severity::Error,
    layer: Layer::Claim,
    summary: "a condition compares NaN",
    why: "a comparison with NaN is never true, so it says nothing about the answer; a measure is NaN when its event never happens",
    bad: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": 0, "explain": "It has a weight.",
 "verify": {"lab": "#1", "runs": {"run": {"until": 0.3}}, "measure": {"t": "first(contact('ball', 'floor'))"}, "options": ["⟦run.t > 2⟧", "!(run.t > 2)"]}}"##,
    ),
    good: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": 0, "explain": "It has a weight.",
 "verify": {"lab": "#1", "runs": {"run": {"until": 1}}, "measure": {"t": "first(contact('ball', 'floor'))"}, "options": ["run.t < 2", "!(run.t < 2)"]}}"##,
    ),
};
