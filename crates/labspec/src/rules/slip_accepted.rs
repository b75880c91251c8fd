use super::Check;
use super::wording::plain;
use crate::spec::{Question, QuestionKind};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// The tolerance of a numeric question accepts the most common slip, a factor of 2.
pub const SLIP_ACCEPTED: &Rule = &Rule {
    code: "slip-accepted",
    severity: Severity::Warning,
    exceptions: &[(Severity::Note, "if the tolerance accepts the answer for g = 10")],
    layer: Layer::Structure,
    summary: "the tolerance of a numeric question accepts the most common slip, a factor of 2",
    why: "a student who forgets the half in an energy, or takes a diameter for a radius, is graded as correct",
    bad: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "numeric", "q": "How fast?", "answer": 4.43, "tol": ⟦2.5⟧}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "numeric", "q": "How fast?", "answer": 4.43, "tol": 0.1}]}"#,
    ),
};

pub(super) const CHECK: Check = Check::Question(check_question);

/// The factor of an answer that is computed with 10 instead of 9.81.
const ROUND: f64 = 10.0 / 9.81;

fn check_question(question: &Question, findings: &mut Vec<Finding>) {
    let Some((answer, tolerance)) = question.numeric() else { return };
    let QuestionKind::Numeric { answer: Some(key), tol, .. } = &question.kind else { return };
    let size = answer.abs();
    // Another rule reports a tolerance that is as large as the answer.
    if size == 0.0 || tolerance >= size || tolerance < 0.0 {
        return;
    }
    let span = tol.as_ref().map_or(&key.span, |t| &t.span).clone();
    let half = answer / 2.0;
    if tolerance >= size / 2.0 {
        findings.push(
            Finding::new(
                SLIP_ACCEPTED,
                span,
                format!("the tolerance accepts {half}, but the answer is {answer}"),
            )
            .related(key.span.clone(), "the answer")
            .help("write in `tol` how far an answer may be off, in its unit; delete it for 2 %"),
        );
    } else if (ROUND - 1.0) * size <= tolerance && plain(question.q.as_str()).contains("9.81") {
        let other = (answer * ROUND * 1e4).round() / 1e4;
        findings.push(
            Finding::new(
                SLIP_ACCEPTED,
                span,
                format!("the question says 9.81, but the tolerance accepts {other}, the answer for g = 10"),
            )
            .severity(Severity::Note)
            .why("rounding g to 10 changes an answer that is proportional to g by 1.9 %")
            .help("make `tol` smaller, unless g = 10 is allowed"),
        );
    }
}
