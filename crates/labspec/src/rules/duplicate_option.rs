use super::Check;
use super::repeated::repeated;
use crate::spec::{Question, QuestionKind};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// Two options of a question have the same text.
pub const DUPLICATE_OPTION: &Rule = &Rule {
    code: "duplicate-option",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "two options of a question have the same text",
    why: "one of them is graded as wrong although it says the same as the right one, or it is a leftover copy",
    bad: Example::Quiz(
        r#"{"id": "fall", "questions": [{"q": "Does mass matter?", "options": ["yes", "no", "⟦no⟧"], "answer": 1}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "fall", "questions": [{"q": "Does mass matter?", "options": ["yes", "no"], "answer": 1}]}"#,
    ),
};

pub(super) const CHECK: Check = Check::Question(check_question);

fn check_question(question: &Question, findings: &mut Vec<Finding>) {
    if let QuestionKind::Choice { options, .. } = &question.kind {
        let help = "change or delete one of them";
        repeated(DUPLICATE_OPTION, "options have the text", help, options.iter(), findings);
    }
}
