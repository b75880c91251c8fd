use labspec_finding::{Example, Layer, Rule, Severity};

/// Decided by `no_value` in `verify/numeric_answer.rs`.
pub const CLAIM_WITHOUT_NUMBER: &Rule = &Rule {
    code: "claim-without-number",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Claim,
    summary: "an expression that must be a number has no numeric value",
    why: "there is no number to compare the claim with",
    bad: Example::Question(
        r##"{"kind": "numeric", "q": "When does it land?", "answer": 0.44, "tol": 0.01, "explain": "Half a second.",
 "verify": {"lab": "#1", "runs": {"run": {"until": 1}}, "value": "⟦1 / (max(data.qpos[2]) - initial(data.qpos[2]))⟧"}}"##,
    ),
    good: Example::Question(
        r##"{"kind": "numeric", "q": "When does it land?", "answer": 0.44, "tol": 0.01, "explain": "Half a second.",
 "verify": {"lab": "#1", "runs": {"run": {"until": 1}}, "value": "first(contact('ball', 'floor'))"}}"##,
    ),
};
