use super::Check;
use crate::spec::Quiz;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A quiz has no questions.
pub const EMPTY_QUIZ: &Rule = &Rule {
    code: "empty-quiz",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "a quiz has no questions",
    why: "the page shows a title and no question",
    bad: Example::Quiz(r#"⟦{⟧"id": "fall", "questions": []}"#),
    good: Example::Quiz(
        r#"{"id": "fall", "questions": [{"q": "Does mass matter?", "options": ["yes", "no"], "answer": 1}]}"#,
    ),
};

pub(super) const CHECK: Check = Check::Quiz(check_quiz);

fn check_quiz(quiz: &Quiz, findings: &mut Vec<Finding>) {
    if quiz.questions.is_empty() {
        findings.push(
            Finding::new(EMPTY_QUIZ, quiz.span.start..quiz.span.start + 1, "this quiz has no questions")
                .help("add \"questions\": [{\"q\": …, \"options\": […], \"answer\": 0}]"),
        );
    }
}
