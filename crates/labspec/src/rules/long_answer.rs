use super::Check;
use super::wording::plain;
use crate::spec::{Question, QuestionKind};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// The correct option is by far the longest.
pub const LONG_ANSWER: &Rule = &Rule {
    code: "long-answer",
    severity: Severity::Note,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "the correct option is by far the longest",
    why: "a student who picks the longest option without reading is graded as correct",
    bad: Example::Quiz(
        r#"{"id": "fall", "questions": [{"q": "Does mass matter?", "options": ["yes", "no", "⟦no: a heavy ball is pulled harder, and is harder to move, by the same factor⟧"], "answer": 2}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "fall", "questions": [{"q": "Does mass matter?", "options": ["yes: a heavy ball is pulled harder", "no: it is also harder to move", "no: mass is no force"], "answer": 1}]}"#,
    ),
};

pub(super) const CHECK: Check = Check::Question(check_question);

/// The minimum ratio to the length of the next option, and the minimum number of extra characters.
const LENGTH_RATIO: usize = 2;
const EXTRA_CHARACTERS: usize = 30;

fn check_question(question: &Question, findings: &mut Vec<Finding>) {
    let QuestionKind::Choice { options, .. } = &question.kind else { return };
    let Some(right) = question.right_option().and_then(|i| options.get(i)) else { return };
    let length = |text: &str| plain(text).chars().count();
    let right_length = length(right.as_str());
    let others = options.iter().filter(|o| !std::ptr::eq(*o, right)).map(|o| length(o.as_str())).max();
    if let Some(next) =
        others.filter(|n| right_length >= LENGTH_RATIO * n && right_length >= n + EXTRA_CHARACTERS)
    {
        findings.push(
            Finding::new(
                LONG_ANSWER,
                right.span(),
                format!(
                    "the correct option has {right_length} characters, the longest other option has {next}"
                ),
            )
            .help("move the reason into `explain`, or give reasons in the other options too"),
        );
    }
}
