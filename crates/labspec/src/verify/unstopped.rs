//! Finds numbers that are the length of a run instead of the time of its event.

use super::bound::BoundVerify;
use super::bound_run::{BoundRun, BoundScene};
use super::compiled_claim::reads_run;
use super::identical_runs::names_measure;
use super::outcome::MeasuredRuns;
use crate::finding::Finding;
use crate::json::read::named;
use crate::rules;
use crate::source::Text;
use crate::spec::format::RUN_LENGTH;

/// Reports each numeric answer and each quoted number that is the time at the end of a run with a `stop` that has not ended it. A
/// condition may state that the event does not happen until then. The runs of a sweep are left out.
pub(super) fn check_unstopped_runs(
    bound: &BoundVerify<'_>,
    outcome: &MeasuredRuns,
    findings: &mut Vec<Finding>,
) {
    for (index, (run, scene)) in bound.runs_with_scenes().enumerate() {
        let (Some(spec), Some(until)) = (run.spec, latest_end(run, scene)) else { continue };
        let Some(stop) = spec.stop.as_ref().filter(|_| run.swept.is_none()) else { continue };
        let measured = outcome.runs.iter().find(|one| one.name == run.name);
        let timestep = scene.scene.model.opt.timestep;
        if measured.is_none_or(|measured| measured.broke.is_some() || measured.end < until - 0.5 * timestep) {
            continue;
        }
        for (i, (name, measure)) in scene.measures.iter().enumerate() {
            // It reads nothing of the simulation but the time.
            if !bound.is_simulated(index, i) || reads_run(&measure.program, false) {
                continue;
            }
            let is_alone = bound.runs.len() == 1;
            let reads = |claim: &&Text| names_measure(claim.as_str(), run.name, name, is_alone);
            findings.extend(numbers(bound).filter(reads).map(|claim| {
                let message = format!(
                    "the run {} ends after {} s, and its `stop` has not held: `{name}` is its length",
                    named(run.name),
                    super::format::significant(until)
                );
                Finding::new(rules::STOP_NEVER_HOLDS, claim.span(), message)
                    .help("let the run be longer, with a larger `until`, or correct its `stop`; that the event does not happen is a condition: `t > 4.9`")
                    .related(stop.span(), "this never holds")
            }));
        }
    }
}

/// The latest end of a run, s. `None` where it is a number of steps.
fn latest_end(run: &BoundRun<'_>, scene: &BoundScene<'_>) -> Option<f64> {
    let spec = run.spec.filter(|spec| spec.steps.is_none())?;
    let until = spec.until.as_ref().or(scene.scene.lab.stop_at.as_ref());
    Some(until.map_or(RUN_LENGTH, |n| n.value))
}

/// The expressions of claimed numbers about single runs. A condition is none.
fn numbers<'v>(bound: &BoundVerify<'v>) -> impl Iterator<Item = &'v Text> {
    let verify = bound.verify;
    let says = verify.says.iter().flat_map(|quote| &quote.exprs);
    verify.value.iter().chain(says).filter(|text| !text.as_str().contains(['<', '>', '=']))
}
