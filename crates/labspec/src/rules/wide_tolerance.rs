use super::Check;
use crate::spec::{Question, QuestionKind};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// The tolerance of a numeric question is as large as its answer.
pub const WIDE_TOLERANCE: &Rule = &Rule {
    code: "wide-tolerance",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "the tolerance of a numeric question is as large as its answer",
    why: "even 0 counts as right, so the question tests nothing",
    bad: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "numeric", "q": "How fast?", "answer": 4.43, "tol": ⟦10⟧}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "numeric", "q": "How fast?", "answer": 4.43, "tol": 0.1}]}"#,
    ),
};

pub(super) const CHECK: Check = Check::Question(check_question);

fn check_question(question: &Question, findings: &mut Vec<Finding>) {
    let QuestionKind::Numeric { answer: Some(answer), tol: Some(tol), .. } = &question.kind else { return };
    if answer.value != 0.0 && tol.value >= answer.value.abs() {
        let [low, high] = [answer.value - tol.value, answer.value + tol.value];
        findings.push(
            Finding::new(
                WIDE_TOLERANCE,
                tol.span.clone(),
                format!("the tolerance accepts every answer from {low} to {high}"),
            )
            .why("the range includes 0, so a student who types 0 without thinking is graded as correct")
            .related(answer.span.clone(), "the answer")
            .help("write in `tol` how far an answer may be off, in its unit; delete it for 2 %"),
        );
    }
}
