use super::Check;
use crate::spec::Question;
use crate::spec::format::MCQ;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// `attempts` is less than 1.
pub const ATTEMPTS_RANGE: &Rule = &Rule {
    code: "attempts-range",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "`attempts` is less than 1",
    why: "a student who cannot try cannot answer",
    bad: Example::Quiz(
        r#"{"id": "fall", "questions": [{"q": "Does mass matter?", "options": ["yes", "no"], "answer": 1, "attempts": ⟦0⟧}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "fall", "questions": [{"q": "Does mass matter?", "options": ["yes", "no"], "answer": 1, "attempts": 2}]}"#,
    ),
};

pub(super) const CHECK: Check = Check::Question(check_question);

fn check_question(question: &Question, findings: &mut Vec<Finding>) {
    if let Some(attempts) = question.attempts().filter(|n| !MCQ.allows("attempts", n.value)) {
        let message = format!("`attempts` is {}, but a student needs at least one", attempts.value);
        findings.push(
            Finding::new(ATTEMPTS_RANGE, attempts.span.clone(), message)
                .help("write 1 or more, or delete `attempts`"),
        );
    }
}
