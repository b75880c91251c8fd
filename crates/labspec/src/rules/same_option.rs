use super::Check;
use super::wording::visible_text;
use crate::json::read::named;
use crate::source::Text;
use crate::spec::{Question, QuestionKind};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};
use std::collections::HashMap;

/// Two options of a question differ only in capitals, punctuation or articles.
pub const SAME_OPTION: &Rule = &Rule {
    code: "same-option",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "two options of a question differ only in capitals, punctuation or articles",
    why: "they say the same thing, and one of them is graded as wrong",
    bad: Example::Quiz(
        r#"{"id": "fall", "questions": [{"q": "What falls faster?", "options": ["The heavy ball", "⟦heavy ball.⟧", "neither"], "answer": 2}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "fall", "questions": [{"q": "What falls faster?", "options": ["The heavy ball", "The light ball", "neither"], "answer": 2}]}"#,
    ),
};

pub(super) const CHECK: Check = Check::Question(check_question);

fn check_question(question: &Question, findings: &mut Vec<Finding>) {
    let QuestionKind::Choice { options, .. } = &question.kind else { return };
    let mut first: HashMap<String, &Text> = HashMap::new();
    for option in options {
        let words = visible_text(option.as_str());
        match first.get(&words) {
            // Another rule reports identical texts.
            Some(before) if before.as_str() != option.as_str() && !words.is_empty() => findings.push(
                Finding::new(
                    SAME_OPTION,
                    option.span(),
                    format!("another option says the same as {}", named(option.as_str())),
                )
                .related(before.span(), "the other one")
                .help("change or delete one of them"),
            ),
            Some(_) => {}
            None => {
                first.insert(words, option);
            }
        }
    }
}
