//! Makes one run to detect breakdowns.

use super::super::PreparedLab;
use super::Trial;
use super::seen::LabDisplays;
use crate::check::observations::{InputsOutOfRange, ObservationHash, Record};
use crate::finding::Finding;
use crate::run::{self, Budget, End, Play, Session, settings};
use crate::spec::Lab;
use crate::stress::{self, Fault, StressCase};
use labspec_core::Model;
use std::ops::ControlFlow;

/// Minimum number of samples of the displayed values, besides the start.
const SAMPLES: usize = 200;

/// Work budget for testing remedies for the breakdowns of a run.
const REMEDY_WORK: u64 = 1_000_000_000;

/// The error that ended a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum EndedRun {
    /// A program of the lab threw.
    Threw,
    /// The work budget ran out.
    Spent,
}

/// A completed run.
pub(super) struct Attempt {
    /// Length of the run, s.
    pub(super) covered: f64,
    /// Work of the run.
    pub(super) spent: u64,
    pub(super) broke: bool,
    /// A program threw, or the engine reset the state after a bad number: the samples are not those of a whole run.
    pub(super) lost: bool,
    pub(super) ended: Option<EndedRun>,
    /// The model at the end of the run.
    pub(super) model: Model,
    /// The samples.
    pub(super) record: Record,
    /// All faults, including silent ones.
    pub(super) faults: Vec<Fault>,
}

/// Makes one run and reports its breakdowns.
///
/// # Errors
/// The run cannot be started.
pub(super) fn make(
    ready: &PreparedLab<'_>,
    case: &StressCase<'_>,
    trial: &Trial<'_>,
    budget: Budget,
    seen: &mut LabDisplays<'_>,
    findings: &mut Vec<Finding>,
) -> Result<Attempt, run::RunError> {
    let (lab, requested) = (ready.lab, trial.length);
    for action in &trial.interaction.actions {
        if let (Some(control), Some(value)) = (lab.controls.get(action.control), &action.value) {
            settings::value(control, value)?;
        }
    }
    let mut session = case.start(&trial.interaction, budget.left);
    let timestep = session.world.model.opt.timestep;
    // The length of a plot can be shortened to the maximum number of steps. A length that the author sets is an error if
    // it is too long.
    let until = lab.stop_at.is_none().then(|| requested.min(timestep * (run::MAX_STEPS - 1) as f64));
    let steps = run::count_steps(lab, until, None, timestep)?;

    let mut watcher = case.watcher(&trial.interaction, &session);
    let every = (steps / SAMPLES).max(1);
    let stop = run::stop_time(lab, until, None, steps);
    let played = Play { stop, watched: true, ..Play::steps(steps) };
    let (mut rows, mut hash, mut beyond) =
        (Vec::new(), ObservationHash::default(), InputsOutOfRange::default());
    let made = run::play(&mut session, &played, |session, step| {
        let is_over = played.is_over(session, step);
        if step % every == 0 || is_over {
            let row = seen.observe(session, &trial.done);
            hash.observe(&row, session);
            if step > 0 {
                beyond.observe(session);
            }
            rows.push(row);
        }
        watcher.observe(session, step, is_over);
        ControlFlow::Continue(())
    });
    let ended = match session.ended() {
        None => None,
        Some(End::Threw | End::Foreign) => Some(EndedRun::Threw),
        Some(End::Budget { .. } | End::Interrupted) => Some(EndedRun::Spent),
    };
    let covered = if made == steps || ended.is_none() { requested } else { made as f64 * timestep };
    let (broke, tried_work) = report_breaks(lab, case, trial, &session, seen, findings);
    findings.extend(seen.take());
    let (spent, faults) = (session.spent() + tried_work, watcher.faults(&session));
    hash.close(&session.world.model);
    let record = Record { moved: trial.moved.clone(), rows, hash, beyond };
    let lost = !session.program_errors.is_empty() || session.warnings.iter().any(|w| w.number > 0);
    Ok(Attempt { covered, spent, broke, lost, ended, model: session.world.model, record, faults })
}

/// Reports errors and breakdowns of a run. Returns whether there were any, and the work of testing remedies.
fn report_breaks(
    lab: &Lab,
    case: &StressCase<'_>,
    trial: &Trial<'_>,
    session: &Session<'_>,
    seen: &mut LabDisplays<'_>,
    findings: &mut Vec<Finding>,
) -> (bool, u64) {
    let before = findings.len();
    for t in &session.program_errors {
        if seen.is_new(t) {
            findings.push(run::error_finding(t, &trial.done));
        }
    }
    let mut tries = REMEDY_WORK;
    for breakdown in run::breakdowns_of(session) {
        // A lab that is expected to break needs no advice.
        let tried = match lab.expect.is_some() {
            true => breakdown,
            false => {
                let tried = stress::with_tried_timestep(
                    case,
                    &trial.interaction,
                    trial.length,
                    breakdown,
                    &mut tries,
                );
                stress::with_tried_end(case, lab, &trial.interaction, trial.length, tried, &mut tries)
            }
        };
        findings.push(run::describe_breakdown(&tried, &trial.done, trial.place(lab)));
    }
    (findings.len() > before, REMEDY_WORK - tries)
}
