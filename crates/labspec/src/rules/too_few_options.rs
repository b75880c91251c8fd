use super::Check;
use crate::printable::counted;
use crate::spec::{Question, QuestionKind};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A question has fewer than two options.
pub const TOO_FEW_OPTIONS: &Rule = &Rule {
    code: "too-few-options",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "a question has fewer than two options",
    why: "a student has nothing to choose",
    bad: Example::Quiz(
        r#"{"id": "fall", "questions": [{"q": "⟦Does mass matter?⟧", "options": ["no"], "answer": 0}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "fall", "questions": [{"q": "Does mass matter?", "options": ["yes", "no"], "answer": 1}]}"#,
    ),
};

pub(super) const CHECK: Check = Check::Question(check_question);

fn check_question(question: &Question, findings: &mut Vec<Finding>) {
    let QuestionKind::Choice { options, .. } = &question.kind else { return };
    if options.len() < 2 {
        let message = format!("this question has {}", counted(options.len(), "option"));
        findings.push(
            Finding::new(TOO_FEW_OPTIONS, question.q.span(), message)
                .help("add options until there are at least two, or use the kind numeric or open"),
        );
    }
}
