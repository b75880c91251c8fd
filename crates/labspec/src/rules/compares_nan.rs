use labspec_finding::{Example, Layer, Rule, Severity};

/// A condition is decided by what is no number.
pub const COMPARES_NAN: &Rule = &Rule {
    code: "compares-nan",
    severity: Severity::Error,
    layer: Layer::Claim,
    summary: "a condition is decided by what is no number",
    why: "A comparison with NaN never holds: it says nothing about the answer. A measure is NaN when its event never happens",
    bad: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": 0, "explain": "It has a weight.",
 "verify": {"lab": "#1", "runs": {"run": {"until": 0.3}}, "measure": {"t": "first(contact('ball', 'floor'))"}, "options": ["⟦run.t > 2⟧", "!(run.t > 2)"]}}"##,
    ),
    good: Example::Question(
        r##"{"kind": "mcq", "q": "What happens to the ball?", "options": ["It falls", "It rises"], "answer": 0, "explain": "It has a weight.",
 "verify": {"lab": "#1", "runs": {"run": {"until": 1}}, "measure": {"t": "first(contact('ball', 'floor'))"}, "options": ["run.t < 2", "!(run.t < 2)"]}}"##,
    ),
};
