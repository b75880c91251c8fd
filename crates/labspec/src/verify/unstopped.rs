//! Finds numbers that are the length of a run instead of the time of its event.

use super::bound::BoundVerify;
use super::bound_run::{BoundRun, BoundScene};
use super::compiled_claim::reads_run;
use super::format::significant;
use super::found::MeasuredValue;
use super::layout::Slot;
use super::outcome::MeasuredRuns;
use crate::finding::Finding;
use crate::json::read::named;
use crate::rules;
use crate::source::Text;
use crate::spec::format::RUN_LENGTH;
use labspec_expr::{Program, Value};

/// Refuses a number that reads the time at the end of a run with a `stop` that has not ended it. A condition may state that the event does
/// not happen until then. The runs of a sweep are left out.
///
/// # Errors
/// The reason, which is reported.
pub(super) fn refuse_run_length(
    bound: &BoundVerify<'_>,
    outcome: &MeasuredRuns,
    found: &MeasuredValue,
    text: &Text,
    findings: &mut Vec<Finding>,
) -> Result<(), String> {
    let Some(claim) = found.claim().filter(|_| !matches!(found.value, Value::Boolean(_))) else {
        return Ok(());
    };
    let slots = &bound.layout().slots;
    let of_measures = claim.reads.iter().filter_map(|place| match slots.get(*place)? {
        Slot::Measure(run, m) => is_time(&bound.measure_at(*run, *m)?.program).then_some(*run),
        _ => None,
    });
    // Aggregates in the text of a claim are those of the first run.
    let aggregates = claim.program.iter().flat_map(Program::aggregates);
    let of_text = aggregates.flat_map(|aggregate| &aggregate.args).filter(|arg| is_time(arg)).map(|_| 0);
    let Some((run, until)) = of_measures.chain(of_text).find_map(|run| unstopped(bound, outcome, run)) else {
        return Ok(());
    };
    let message = format!(
        "the run {} ends after {} s without reaching its `stop`, so this number is only the length of the run",
        named(run.name),
        significant(until)
    );
    let finding = Finding::new(rules::STOP_NEVER_HOLDS, text.span(), message.clone())
        .help("raise `until`, or correct `stop`; to claim that the event does not happen, write a condition such as `t > 4.9`");
    findings.push(match run.spec.and_then(|spec| spec.stop.as_ref()) {
        Some(stop) => finding.related(stop.span(), "this never holds"),
        None => finding,
    });
    Err(message)
}

/// Whether a program reads the time, and nothing else of the simulation.
fn is_time(program: &Program) -> bool {
    reads_run(program, true) && !reads_run(program, false)
}

/// A run with a `stop` that has not ended it, and its latest end, s.
fn unstopped<'b, 'a>(
    bound: &'b BoundVerify<'a>,
    outcome: &MeasuredRuns,
    index: usize,
) -> Option<(&'b BoundRun<'a>, f64)> {
    let run = bound.runs.get(index).filter(|run| run.stop.is_some() && run.swept.is_none())?;
    let scene = bound.scene_of(run)?;
    let until = latest_end(run, scene)?;
    let measured = outcome.runs.iter().find(|one| one.name == run.name)?;
    let is_whole = measured.end >= until - 0.5 * scene.scene.model.opt.timestep;
    (measured.broke.is_none() && is_whole).then_some((run, until))
}

/// The latest end of a run, s. `None` where it is a number of steps.
fn latest_end(run: &BoundRun<'_>, scene: &BoundScene<'_>) -> Option<f64> {
    let spec = run.spec.filter(|spec| spec.steps.is_none())?;
    let until = spec.until.as_ref().or(scene.scene.lab.stop_at.as_ref());
    Some(until.map_or(RUN_LENGTH, |n| n.value))
}

#[cfg(test)]
mod tests {
    /// The codes of the errors about a fall from 1 m that a run of 0.3 s does not end, and one of 2 s does.
    fn codes(until: f64, question: serde_json::Value) -> Vec<String> {
        let xml =
            "<mujoco><worldbody><body pos='0 0 1'><freejoint/><geom size='.05'/></body></worldbody></mujoco>";
        let lab = serde_json::json!({"stopAt": 2, "xml": xml});
        let mut question = question;
        question["q"] = "When does it land?".into();
        for (key, value) in [
            ("lab", lab),
            ("runs", serde_json::json!({"fall": {"stop": "data.qpos[2] < 0.1", "until": until}})),
            ("measure", serde_json::json!({"t": "final(data.time)", "late": "2 * final(data.time)"})),
        ] {
            question["verify"][key] = value;
        }
        let quiz = serde_json::json!({"id": "q", "questions": [question]}).to_string();
        let report = crate::Checker::new(|_: &str| None::<String>).check("q.json", &quiz);
        report.findings.iter().map(|finding| finding.code.to_string()).collect()
    }

    #[test]
    fn the_length_of_a_run_is_no_number_of_the_simulation() {
        let numeric = |answer: f64, value: &str| serde_json::json!({"kind": "numeric", "answer": answer, "tol": 0.01, "unit": "s", "verify": {"value": value}});
        for (answer, value) in
            [(0.3, "fall.t"), (0.3, "t"), (0.6, "fall.late"), (0.3, "final(data.time)"), (0.6, "2 * t")]
        {
            assert_eq!(codes(0.3, numeric(answer, value)), ["stop-never-holds"], "{value}");
        }
        assert_eq!(codes(2.0, numeric(0.43, "fall.t")), [""; 0]);
        // That the event does not happen is a condition.
        let statement = serde_json::json!({"kind": "truefalse", "answer": true, "verify": {"options": ["fall.t > 0.29"]}});
        assert!(!codes(0.3, statement).contains(&"stop-never-holds".to_string()));
    }
}
