use super::Check;
use super::claims;
use crate::spec::Lesson;
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A run has both `until` and `steps`.
pub const RUN_LENGTH: &Rule = &Rule {
    code: "run-length",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "a run has both `until` and `steps`",
    why: "the two may contradict each other",
    bad: Example::Lab(
        r#"{"model": "ball", "note": "It rests at 0.10 m.", "verify": {"runs": {"drop": {"until": 2, "steps": ⟦500⟧}}, "says": [["0.10 m", "final(data.qpos[2])"]]}}"#,
    ),
    good: Example::Lab(
        r#"{"model": "ball", "note": "It rests at 0.10 m.", "verify": {"runs": {"drop": {"until": 2}}, "says": [["0.10 m", "final(data.qpos[2])"]]}}"#,
    ),
};

pub(super) const CHECK: Check = Check::Lesson(check_lesson);

fn check_lesson(lesson: &Lesson, findings: &mut Vec<Finding>) {
    for run in claims::all(lesson).flat_map(|claim| &claim.verify.runs) {
        if let (Some(until), Some(steps)) = (&run.until, &run.steps) {
            findings.push(
                Finding::new(RUN_LENGTH, steps.span.clone(), "this run has both `until` and `steps`")
                    .related(until.span.clone(), "its length in seconds")
                    .help("keep one of the two"),
            );
        }
    }
}
