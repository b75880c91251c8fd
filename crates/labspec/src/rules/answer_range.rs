use super::Check;
use crate::json::Number;
use crate::spec::{KeyValue, Question, QuestionKind};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// `answer` is not the index of an option.
pub const ANSWER_RANGE: &Rule = &Rule {
    code: "answer-range",
    severity: Severity::Error,
    exceptions: &[],
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
    let QuestionKind::Choice { options, key: Some(key), .. } = &question.kind else { return };
    let indexes = match &key.value {
        KeyValue::Option(index) => std::slice::from_ref(index),
        KeyValue::Options(indexes) => indexes.as_slice(),
        KeyValue::Truth(_) | KeyValue::Hash(_) => &[],
    };
    for index in indexes.iter().filter(|index| options.len() >= 2 && !is_option(index, options.len())) {
        let last = options.len() - 1;
        let message =
            format!("`answer` is {}, which is not the index of an option (0 to {last})", index.value);
        findings.push(Finding::new(ANSWER_RANGE, index.span.clone(), message).help(
            if index.value == options.len() as f64 {
                format!("count options from 0: the index of the last one is {last}")
            } else {
                format!("write a number from 0 to {last}")
            },
        ));
    }
}

fn is_option(index: &Number, count: usize) -> bool {
    (0..count).any(|i| i as f64 == index.value)
}
