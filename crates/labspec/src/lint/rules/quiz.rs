//! Questions that cannot be answered.

use super::plot::repeated;
use crate::finding::{Finding, Severity};
use crate::spec::{Question, QuestionKind, Quiz};
use labspec_finding::{Example, Layer, Rule};

/// A quiz without questions.
pub static EMPTY_QUIZ: Rule = Rule {
    code: "empty-quiz",
    severity: Severity::Error,
    layer: Layer::Structure,
    summary: "a quiz has no questions",
    why: "it shows a title and nothing to do",
    bad: Example::Quiz(r#"{"id": "fall", "questions": []}"#),
    good: Example::Quiz(
        r#"{"id": "fall", "questions": [{"q": "Does mass matter?", "options": ["yes", "no"], "answer": 1}]}"#,
    ),
};

/// Fewer than two options.
pub static FEW_OPTIONS: Rule = Rule {
    code: "too-few-options",
    severity: Severity::Error,
    layer: Layer::Structure,
    summary: "a question has fewer than two options",
    why: "there is nothing to choose",
    bad: Example::Quiz(
        r#"{"id": "fall", "questions": [{"q": "Does mass matter?", "options": ["no"], "answer": 0}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "fall", "questions": [{"q": "Does mass matter?", "options": ["yes", "no"], "answer": 1}]}"#,
    ),
};

/// The index of the answer is not that of an option.
pub static ANSWER_RANGE: Rule = Rule {
    code: "answer-range",
    severity: Severity::Error,
    layer: Layer::Structure,
    summary: "the answer is not the index of an option",
    why: "no choice is right, and every student is told to be wrong",
    bad: Example::Quiz(
        r#"{"id": "fall", "questions": [{"q": "Does mass matter?", "options": ["yes", "no"], "answer": 2}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "fall", "questions": [{"q": "Does mass matter?", "options": ["yes", "no"], "answer": 1}]}"#,
    ),
};

/// Two options with one text.
pub static DUPLICATE_OPTION: Rule = Rule {
    code: "duplicate-option",
    severity: Severity::Error,
    layer: Layer::Structure,
    summary: "two options of a question have the same text",
    why: "one of them is graded as wrong although it says what the right one says, or it is a copy left over",
    bad: Example::Quiz(
        r#"{"id": "fall", "questions": [{"q": "Does mass matter?", "options": ["yes", "no", "no"], "answer": 1}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "fall", "questions": [{"q": "Does mass matter?", "options": ["yes", "no"], "answer": 1}]}"#,
    ),
};

/// An answer of 0 with the default tolerance.
pub static ZERO_TOLERANCE: Rule = Rule {
    code: "zero-tolerance",
    severity: Severity::Error,
    layer: Layer::Structure,
    summary: "a numeric question with the answer 0 states no tolerance",
    why: "the default is 2 % of the answer, and 2 % of 0 is 0: only an exact 0 counts as right",
    bad: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "numeric", "q": "Drift in mm?", "answer": 0}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "numeric", "q": "Drift in mm?", "answer": 0, "tol": 0.01}]}"#,
    ),
};

/// A tolerance that no typed number can meet.
pub static TOLERANCE: Rule = Rule {
    code: "impossible-tolerance",
    severity: Severity::Error,
    layer: Layer::Structure,
    summary: "the tolerance of a numeric question is negative, or 0 for an answer that is no whole number",
    why: "an answer is right when it is off by no more than `tol`; a count may be asked exactly, a measured number may not",
    bad: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "numeric", "q": "How fast?", "answer": 4.43, "tol": 0}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "numeric", "q": "How many steps?", "answer": 250, "tol": 0}]}"#,
    ),
};

pub(in crate::lint) const RULES: &[&Rule] =
    &[&EMPTY_QUIZ, &FEW_OPTIONS, &ANSWER_RANGE, &DUPLICATE_OPTION, &ZERO_TOLERANCE, &TOLERANCE];

pub(in crate::lint) fn check(quiz: &Quiz, findings: &mut Vec<Finding>) {
    if quiz.questions.is_empty() {
        findings.push(
            Finding::new(&EMPTY_QUIZ, quiz.span.start..quiz.span.start + 1, "this quiz has no questions")
                .help("add \"questions\": [{\"q\": …, \"options\": […], \"answer\": 0}]"),
        );
    }
    for (_, question) in quiz.numbered() {
        check_question(question, findings);
    }
}

fn check_question(question: &Question, findings: &mut Vec<Finding>) {
    match &question.kind {
        QuestionKind::Choice { options, answer, .. } => {
            if options.len() < 2 {
                findings.push(
                    Finding::new(
                        &FEW_OPTIONS,
                        question.q.span(),
                        format!(
                            "this question has {} option{}",
                            options.len(),
                            if options.len() == 1 { "" } else { "s" }
                        ),
                    )
                    .help("give at least two, or make it a question of kind numeric or open"),
                );
            }
            if let Some(answer) = answer
                && question.right_option().is_none()
                && options.len() >= 2
            {
                let last = options.len() - 1;
                findings.push(
                    Finding::new(
                        &ANSWER_RANGE,
                        answer.span.clone(),
                        format!(
                            "answer {} is not the index of an option; they run from 0 to {last}",
                            answer.value
                        ),
                    )
                    .help(if answer.value == options.len() as f64 {
                        format!("options are counted from 0: the last one is {last}")
                    } else {
                        format!("write a number from 0 to {last}")
                    }),
                );
            }
            repeated(
                &DUPLICATE_OPTION,
                "options have the text",
                "change or delete one of them",
                options.iter(),
                findings,
            );
        }
        QuestionKind::Numeric { answer: Some(answer), tol, .. } => {
            if answer.value == 0.0 && tol.is_none() {
                findings.push(
                    Finding::new(
                        &ZERO_TOLERANCE,
                        answer.span.clone(),
                        "the answer is 0 and there is no `tol`",
                    )
                    .help("add \"tol\": how far an answer may be off, in its unit"),
                );
            }
            let whole = answer.value.fract() == 0.0;
            if let Some(tol) = tol.as_ref().filter(|t| t.value < 0.0 || (t.value == 0.0 && !whole)) {
                findings.push(
                    Finding::new(
                        &TOLERANCE,
                        tol.span.clone(),
                        format!("no answer can be within {} of {}", tol.value, answer.value),
                    )
                    .help("write how far an answer may be off, in its unit; leave `tol` out for 2 %"),
                );
            }
        }
        _ => {}
    }
}
