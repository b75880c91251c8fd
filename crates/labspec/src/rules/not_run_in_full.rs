use crate::check::{Coverage, RanLab};
use crate::json::Number;
use crate::printable::counted;
use crate::run::two_digits;
use crate::spec::{Lab, Lesson};
use labspec_finding::{Example, Finding, Layer, Rule, Severity};

/// A lab was not run to its end, and no other finding says why.
pub const NOT_RUN_IN_FULL: &Rule = &Rule {
    code: "not-run-in-full",
    severity: Severity::Warning,
    exceptions: &[],
    layer: Layer::Run,
    summary: "a lab was not run in full, and no other finding says why",
    why: "a check limits the work of its runs; the rest of the lab is not tested, so the check fails. `stopAt` and `window` are in seconds",
    bad: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody></mujoco>", "setup": "data.qvel[0] = 1", "stopAt": ⟦30000⟧, "readouts": [{"label": "angle", "expr": "data.qpos[0]", "digits": 1}]}"#,
    ),
    good: Example::Lab(
        r#"{"xml": "<mujoco><worldbody><body name='rod'><joint name='hinge' axis='0 1 0'/><geom type='capsule' size='.02' fromto='0 0 0 0 0 -1'/></body></worldbody></mujoco>", "setup": "data.qvel[0] = 1", "stopAt": 3, "readouts": [{"label": "angle", "expr": "data.qpos[0]", "digits": 1}]}"#,
    ),
};

/// A longer run was probably meant to be shorter, s.
const LONG: f64 = 100.0;

/// Adds a finding for each lab that was not run to its end, where no other finding says why. A lab whose model cannot be loaded
/// has findings in the file of its model.
pub(crate) fn explain(lesson: &Lesson, labs: &[RanLab], findings: &mut Vec<Finding>) {
    let mut added = Vec::new();
    for ran in labs.iter().filter(|ran| crate::check::is_unfinished(ran)) {
        let (Some(tried), Some(lab)) = (&ran.tried, lesson.lab(&ran.address)) else { continue };
        let inside = |f: &Finding| f.span.start <= lab.span.end && lab.span.start <= f.span.end;
        let mut problems = findings.iter().filter(|f| f.severity != Severity::Note);
        if !problems.any(|f| inside(f) && (tried.covered >= tried.requested || f.is_error())) {
            added.push(of_lab(tried, lab));
        }
    }
    findings.extend(added);
}

/// The finding for a lab that did not run to its end.
fn of_lab(tried: &Coverage, lab: &Lab) -> Finding {
    let about = |place, message: String| Finding::new(NOT_RUN_IN_FULL, place, message);
    if tried.covered >= tried.requested {
        let runs = counted(tried.skipped, "run");
        return about(lab.place(), format!("the check skipped {runs} of this lab"))
            .help("shorten `stopAt`, or use fewer controls");
    }
    let [covered, requested] = [tried.covered, tried.requested].map(seconds);
    let message = format!("this lab ran for only {covered} of {requested} s");
    let widest = lab.plots.iter().filter_map(|p| p.window.as_ref());
    let longest = widest.max_by(|a, b| a.value.total_cmp(&b.value));
    let positive = |n: &&Number| n.value > 0.0;
    let (key, length) = match (lab.stop_at.as_ref().filter(positive), longest) {
        (Some(stop), _) => ("stopAt", stop),
        (None, Some(window)) => ("window", window),
        (None, None) => return about(lab.place(), message).help("add a `stopAt`, in seconds"),
    };
    let finding = about(length.span.clone(), message);
    if tried.requested < LONG {
        return finding.help(format!("shorten `{key}`, or simplify the model or the programs of the lab"));
    }
    finding.help(format!(
        "`{key}` is in seconds, and {requested} s is {}: write a shorter time",
        duration(tried.requested)
    ))
}

fn seconds(t: f64) -> String {
    if t >= 10.0 || t == 0.0 { format!("{t:.0}") } else { two_digits(t) }
}

/// A long time in words: `2 h 13 min`.
pub(crate) fn duration(seconds: f64) -> String {
    let (minutes, rest) = ((seconds / 60.0).floor(), seconds % 60.0);
    let (hours, minutes_left) = ((minutes / 60.0).floor(), minutes % 60.0);
    let (days, hours_left) = ((hours / 24.0).floor(), hours % 24.0);
    match (days >= 1.0, hours >= 1.0) {
        (true, _) => format!("{days:.0} d {hours_left:.0} h"),
        (false, true) => format!("{hours:.0} h {minutes_left:.0} min"),
        (false, false) => format!("{minutes:.0} min {rest:.0} s"),
    }
}

#[cfg(test)]
mod tests {
    use super::duration;

    #[test]
    fn long_times_in_words() {
        for (seconds, words) in
            [(8000.0, "2 h 13 min"), (100.0, "1 min 40 s"), (3600.0, "1 h 0 min"), (2e5, "2 d 7 h")]
        {
            assert_eq!(duration(seconds), words);
        }
    }
}
