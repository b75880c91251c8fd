use super::Check;
use crate::spec::{Question, QuestionKind};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// The tolerance of a numeric question is negative, too small to type, or 0 for an answer that is not an integer.
pub const IMPOSSIBLE_TOLERANCE: &Rule = &Rule {
    code: "impossible-tolerance",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "the tolerance of a numeric question is negative, too small to type, or 0 for an answer that is not an integer",
    why: "an answer is right if it differs by at most `tol`; a count may be asked exactly, a measured number may not",
    bad: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "numeric", "q": "How fast?", "answer": 4.43, "tol": ⟦0⟧}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "numeric", "q": "How many steps?", "answer": 250, "tol": 0}]}"#,
    ),
};

/// The smallest relative tolerance that an answer may require.
const MIN_RELATIVE_TOLERANCE: f64 = 1e-9;

pub(super) const CHECK: Check = Check::Question(check_question);

fn check_question(question: &Question, findings: &mut Vec<Finding>) {
    let QuestionKind::Numeric { answer: Some(answer), tol: Some(tol), .. } = &question.kind else { return };
    let whole = answer.value.fract() == 0.0;
    let too_small = tol.value > 0.0 && tol.value < MIN_RELATIVE_TOLERANCE * answer.value.abs();
    if too_small {
        let message = format!("a tolerance of {} accepts only {}", tol.value, answer.value);
        findings.push(
            Finding::new(IMPOSSIBLE_TOLERANCE, tol.span.clone(), message)
                .why("the tolerance is less than a billionth of the answer, so an answer would need more digits than anyone types")
                .help("write how far an answer may be off, in its unit; delete `tol` for 2 %, or write 0 for a count"),
        );
    } else if tol.value < 0.0 || (tol.value == 0.0 && !whole) {
        let message = format!("no answer is within {} of {}", tol.value, answer.value);
        findings.push(
            Finding::new(IMPOSSIBLE_TOLERANCE, tol.span.clone(), message)
                .help("write how far an answer may be off, in its unit; delete `tol` for 2 %"),
        );
    }
}
