use super::Check;
use super::claims;
use crate::json::read::shorten;
use crate::printable::counted;
use crate::source::Text;
use crate::spec::{Lesson, Question, QuestionKind, Verify};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// `verify` lacks a condition for an option, has a value where no number is asked, or uses an unknown unit.
pub const VERIFY_ANSWER: &Rule = &Rule {
    code: "verify-answer",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "`verify` lacks a condition for an option, has a value where no number is asked, or uses an unknown unit",
    why: "exactly one condition must be true, that of the correct option, so every option needs one",
    bad: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "predict", "q": "What does it do?", "options": ["falls", "rises", "stays"], "answer": 0, "sim": {"model": "ball"}, "verify": {"runs": {"run": {"until": 0.4}}, "measure": {"z": "final(data.qpos[2])"}, "options": ["⟦z < 0.9⟧", "z > 1.1"]}}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "predict", "q": "What does it do?", "options": ["falls", "rises", "stays"], "answer": 0, "sim": {"model": "ball"}, "verify": {"runs": {"run": {"until": 0.4}}, "measure": {"z": "final(data.qpos[2])"}, "options": ["z < 0.9", "z > 1.1", "0.9 <= z && z <= 1.1"]}}]}"#,
    ),
};

pub(super) const CHECK: Check = Check::Lesson(check_lesson);

fn check_lesson(lesson: &Lesson, findings: &mut Vec<Finding>) {
    for claim in claims::all(lesson) {
        let verify = claim.verify;
        if let Some((label, _)) = verify.over.first().filter(|_| verify.options.is_empty()) {
            findings.push(
                Finding::new(
                    VERIFY_ANSWER,
                    label.span(),
                    "`over` gives a range, but the object has no `options` to test in it",
                )
                .help("write `options`, one condition for each option of the question"),
            );
        }
        let Some(question) = claim.question else {
            for text in verify.options.first().into_iter().chain(&verify.value).chain(verify.wrong.first()) {
                findings.push(
                    Finding::new(
                        VERIFY_ANSWER,
                        text.span(),
                        "`options`, `value` and `wrong` need a question, but this `verify` belongs to none",
                    )
                    .help("move it to the question, or write it as [quote, expression] under `says`"),
                );
            }
            continue;
        };
        check_count(verify, question, findings);
        if let Some(wrong) = verify.wrong.first().filter(|_| verify.value.is_none()) {
            findings.push(
                Finding::new(VERIFY_ANSWER, wrong.span(), "`wrong` has no `value` beside it")
                    .help("add `value`, on a question of kind numeric"),
            );
        }
        if let Some(value) = &verify.value
            && !matches!(question.kind, QuestionKind::Numeric { .. })
        {
            findings.push(
                Finding::new(VERIFY_ANSWER, value.span(), "this question does not ask for a number")
                    .help("use `options` or `says`: `value` is for questions of kind numeric"),
            );
        }
    }
}

/// Checks that there are as many conditions as options, or one for a statement.
fn check_count(verify: &Verify, question: &Question, findings: &mut Vec<Finding>) {
    let options = question.condition_count();
    let is_statement = matches!(question.kind, QuestionKind::TrueFalse { .. });
    let conditions = verify.options.len();
    if conditions > 0 && conditions != options {
        let span = verify.options.first().map_or(verify.span.clone(), Text::span);
        findings.push(
            Finding::new(
                VERIFY_ANSWER,
                span,
                if is_statement {
                    format!("`options` has {conditions} conditions for one statement")
                } else {
                    format!("`options` has {conditions} conditions for {options} options")
                },
            )
            .help(count_help(conditions, question)),
        );
    }
}

/// Which conditions to add or to delete.
fn count_help(conditions: usize, question: &Question) -> String {
    let QuestionKind::Choice { options, .. } = &question.kind else {
        return "write one condition, which holds if the statement is true".into();
    };
    match options.get(conditions..) {
        Some([first, others @ ..]) => {
            let more = if others.is_empty() { "" } else { " and for each option after it" };
            format!(
                "write one condition per option, in their order: add one for \"{}\"{more}, or `\"undecided\"`",
                shorten(first.as_str())
            )
        }
        _ => format!(
            "write one condition per option, in their order: delete {}",
            counted(conditions - options.len(), "condition")
        ),
    }
}
