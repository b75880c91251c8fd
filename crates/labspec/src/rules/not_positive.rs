use super::Check;
use super::claims;
use crate::json::Number;
use crate::spec::Lesson;
use crate::spec::format::{FIND, INTEGRATORS, LAB, Object, PLOT, RUN};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A time, size or speed is zero or negative.
pub const NOT_POSITIVE: &Rule = &Rule {
    code: "not-positive",
    severity: Severity::Error,
    exceptions: &[],
    layer: Layer::Structure,
    summary: "a time, size or speed is zero or negative",
    why: "there is nothing to run or to draw, so the lab shows nothing",
    bad: Example::Lab(r#"{"model": "ball", "stopAt": ⟦0⟧}"#),
    good: Example::Lab(r#"{"model": "ball", "stopAt": 1.5}"#),
};

pub(super) const CHECK: Check = Check::Lesson(check_lesson);

fn check_lesson(lesson: &Lesson, findings: &mut Vec<Finding>) {
    let mut positive = |object: &Object, name: &str, number: Option<&Number>, means: &str| {
        if let Some(number) = number.filter(|n| !object.allows(name, n.value)) {
            let message = format!("`{name}` is {}, but it must be positive", number.value);
            findings.push(
                Finding::new(NOT_POSITIVE, number.span.clone(), message)
                    .help(format!("write a positive value: {means}")),
            );
        }
    };
    for lab in lesson.all_labs() {
        positive(&LAB, "stopAt", lab.stop_at.as_ref(), "the time in seconds at which the lab pauses");
        positive(&LAB, "height", lab.height.as_ref(), "pixels");
        positive(&LAB, "forceScale", lab.force_scale.as_ref(), "metres per newton");
        let timestep = lab.comparison.as_ref().and_then(|comparison| comparison.timestep.as_ref());
        positive(&INTEGRATORS, "timestep", timestep, "the timestep in seconds");
        for speed in &lab.speeds {
            positive(&LAB, "speeds", Some(speed), "the playback speed relative to real time");
        }
        for plot in &lab.plots {
            positive(&PLOT, "window", plot.window.as_ref(), "seconds");
            positive(&PLOT, "height", plot.height.as_ref(), "pixels");
        }
    }
    for find in claims::all(lesson).flat_map(|claim| &claim.verify.find) {
        positive(&FIND, "tol", Some(&find.tol), "the accuracy of the search");
    }
    for run in claims::all(lesson).flat_map(|claim| &claim.verify.runs) {
        positive(&RUN, "until", run.until.as_ref(), "the length of the run in seconds");
        positive(&RUN, "steps", run.steps.as_ref(), "the length of the run in steps");
    }
}
