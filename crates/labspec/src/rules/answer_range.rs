use super::Check;
use crate::spec::{Question, QuestionKind};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// `answer` is not the index of an option.
pub const ANSWER_RANGE: &Rule = &Rule {
    code: "answer-range",
    severity: Severity::Error,
    layer: Layer::Structure,
    summary: "`answer` is not the index of an option",
    why: "no option is graded as correct, so every student is graded as wrong",
    bad: Example::Quiz(
        r#"{"id": "fall", "questions": [{"q": "Does mass matter?", "options": ["yes", "no"], "answer": ⟦2⟧}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "fall", "questions": [{"q": "Does mass matter?", "options": ["yes", "no"], "answer": 1}]}"#,
    ),
};

pub(super) const CHECK: Check = Check::Question(check_question);

fn check_question(question: &Question, findings: &mut Vec<Finding>) {
    let QuestionKind::Choice { options, answer: Some(answer), .. } = &question.kind else { return };
    if question.right_option().is_none() && options.len() >= 2 {
        let last = options.len() - 1;
        let message =
            format!("`answer` is {}, which is not the index of an option (0 to {last})", answer.value);
        findings.push(Finding::new(ANSWER_RANGE, answer.span.clone(), message).help(
            if answer.value == options.len() as f64 {
                format!("count options from 0: the index of the last one is {last}")
            } else {
                format!("write a number from 0 to {last}")
            },
        ));
    }
}
