use super::Check;
use crate::spec::{Question, QuestionKind};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A numeric question with the answer 0 states no tolerance.
pub const ZERO_TOLERANCE: &Rule = &Rule {
    code: "zero-tolerance",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "a numeric question with the answer 0 states no tolerance",
    why: "the default is 2 % of the answer, and 2 % of 0 is 0: only an exact 0 counts as right",
    bad: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "numeric", "q": "Drift in mm?", "answer": ⟦0⟧}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "numeric", "q": "Drift in mm?", "answer": 0, "tol": 0.01}]}"#,
    ),
};

pub(super) const CHECK: Check = Check::Question(check_question);

fn check_question(question: &Question, findings: &mut Vec<Finding>) {
    if let QuestionKind::Numeric { answer: Some(answer), tol: None, .. } = &question.kind
        && answer.value == 0.0
    {
        findings.push(
            Finding::new(ZERO_TOLERANCE, answer.span.clone(), "the answer is 0 and has no `tol`")
                .help("add \"tol\": how far an answer may be off, in its unit"),
        );
    }
}
