use super::Check;
use super::claims;
use crate::spec::Lesson;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A `verify` object has no lab to run.
pub const VERIFY_WITHOUT_LAB: &Rule = &Rule {
    code: "verify-without-lab",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "a `verify` object has no lab to run",
    why: "the question has no `sim`, so `verify` must name the lab; formulas alone need no lab",
    bad: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "numeric", "q": "How fast?", "answer": 3.924, "verify": ⟦{⟧"runs": {"run": {"until": 0.4}}, "value": "final(-data.qvel[2])"}}]}"#,
    ),
    good: Example::Quiz(
        r#"{"id": "fall", "questions": [{"kind": "numeric", "q": "How fast?", "answer": 3.924, "verify": {"lab": {"model": "ball"}, "runs": {"run": {"until": 0.4}}, "value": "final(-data.qvel[2])"}}]}"#,
    ),
};

pub(super) const CHECK: Check = Check::Lesson(check_lesson);

fn check_lesson(lesson: &Lesson, findings: &mut Vec<Finding>) {
    let without = |c: &claims::LessonClaim<'_>| {
        lesson.whole(c.verify).lab.is_none()
            && c.lab.is_none()
            && !c.verify.is_formulas()
            && !c.verify.every_run_names_its_lab()
    };
    for claim in claims::all(lesson).filter(without) {
        let start = claim.verify.span.start;
        findings.push(
            Finding::new(VERIFY_WITHOUT_LAB, start..start + 1, "this `verify` object has no lab to run")
                .help("add \"lab\": \"#1\" for the first lab of the lesson, or a lab object; formulas without `data` and `model` need no lab"),
        );
    }
}
