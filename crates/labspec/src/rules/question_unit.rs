use super::Check;
use crate::spec::{Question, QuestionKind};
use crate::verify::{asked_unit, differ_in_scale};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// The text of a numeric question asks for another unit than the one beside the field of its answer.
pub const QUESTION_UNIT: &Rule = &Rule {
    code: "question-unit",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "the text of a numeric question asks for a different unit than the one displayed beside the answer field",
    why: "a student who answers in the unit of the text is graded as wrong",
    bad: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "numeric", "q": "How fast does it land, in km/h?", "answer": 4.43, "tol": 0.05, "unit": "⟦m/s⟧"}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "numeric", "q": "How fast does it land, in m/s?", "answer": 4.43, "tol": 0.05, "unit": "m/s"}]}"#,
    ),
};

pub(super) const CHECK: Check = Check::Question(check_question);

fn check_question(question: &Question, findings: &mut Vec<Finding>) {
    let QuestionKind::Numeric { unit: Some(unit), .. } = &question.kind else { return };
    let Some(asked) = asked_unit(question.q.as_str()) else { return };
    if differ_in_scale(&asked, unit.as_str()) {
        let message = format!("the question asks for {asked}, but the answer is in {}", unit.as_str());
        findings.push(
            Finding::new(QUESTION_UNIT, unit.span(), message)
                .help(format!("ask for {}, or give the answer in {asked}", unit.as_str()))
                .related(question.q.span(), "the question"),
        );
    }
}
