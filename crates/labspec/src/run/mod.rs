//! Runs a lab without a page: executes its events in order and samples it into a table.

mod breakdown;
mod budget;
mod cell;
mod diagnose;
mod evaluate;
mod held;
mod integrator;
mod messages;
mod play;
mod program_error;
mod samples;
mod session;
pub mod settings;
mod silent;
mod steady;
mod table;
mod variant;
mod watched;

pub use breakdown::{Breakdown, ShorterTimestep, attribute_to_soften, time};
pub use budget::{Budget, End};
pub use cell::{Cell, printed, rounded};
pub use diagnose::{breakdowns_of, worst_breakdown};
pub use held::ProgramsRef;
pub use integrator::{INTEGRATORS, Integrator, sets_integrator};
pub use labspec_finding::two_digits;
pub use labspec_monitors::stability::{how_stiff, owner};
pub use messages::{describe_breakdown, error_finding};
pub use play::{Play, StopTime, play};
pub use program_error::ProgramError;
pub use samples::Samples;
pub use session::{Session, Start};
pub use settings::{presses, presses_within, set_controls, swept_value};
pub use steady::is_steady;
pub use table::{FinalValue, Table, final_values};
pub use variant::StepVariant;

use crate::bind::Programs;
use crate::spec::Lab;
use crate::spec::format::RUN_LENGTH;
use labspec_core::reflect::FieldSet;
use labspec_core::{AccessSet, Model, Plan};
use labspec_expr::Value;
use std::ops::ControlFlow;

/// The interactions during a run, and its length.
#[derive(Clone, Debug, Default)]
pub struct RunOptions {
    /// Length in seconds; without it and `steps`, the `stopAt` of the lab, or 2 s.
    pub until: Option<f64>,
    /// Length in steps.
    pub steps: Option<usize>,
    /// Number of steps between two rows.
    pub every: usize,
    /// Controls by label, and their values before the first step.
    pub set: Vec<(String, Value)>,
    /// Buttons by label, with the times at which they are pressed, s.
    pub press: Vec<(String, f64)>,
    /// Computes every field in every step, read or not.
    pub full: bool,
}

/// Maximum number of steps of one run. A lesson takes minutes at most; a mistyped length would run practically forever.
pub const MAX_STEPS: usize = 20_000_000;
/// A run of this length was probably meant in milliseconds, s.
const LONG_RUN: f64 = 1000.0;
/// Maximum number of cells of a table.
const MAX_CELLS: usize = 10_000_000;
/// Maximum number of bytes of its texts.
const MAX_TEXT: usize = 64 << 20;

/// Why a run did not start.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RunError {
    /// What prevents it.
    pub message: String,
    /// What to write instead, if that is known.
    pub help: Option<String>,
}

impl RunError {
    /// An error without advice.
    pub fn new(message: impl Into<String>) -> RunError {
        RunError { message: message.into(), help: None }
    }

    /// Adds advice.
    pub(crate) fn help(self, help: impl Into<String>) -> RunError {
        RunError { help: Some(help.into()), ..self }
    }
}

impl std::fmt::Display for RunError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match &self.help {
            Some(help) => write!(f, "{}: {help}", self.message),
            None => f.write_str(&self.message),
        }
    }
}

impl std::error::Error for RunError {}

/// The `stopAt` of a lab. Another rule reports one that is not positive.
fn stated_length(lab: &Lab) -> Option<f64> {
    lab.stop_at.as_ref().map(|stop| stop.value).filter(|length| *length > 0.0)
}

/// The time at which a run of a lab ends; `None` for a run whose length is given, or that of a lab without `stopAt`. `count`
/// is the number of steps up to this time.
pub fn stop_time(lab: &Lab, until: Option<f64>, steps: Option<usize>, count: usize) -> Option<StopTime> {
    let is_given = until.is_some() || steps.is_some();
    stated_length(lab).filter(|_| !is_given).map(|time| StopTime::after(time, count))
}

/// Number of steps of a length. Up to the `stopAt` of a lab, it is that of the first sample with this time or a later one.
///
/// # Errors
/// More than [`MAX_STEPS`].
pub fn count_steps(
    lab: &Lab,
    until: Option<f64>,
    steps: Option<usize>,
    timestep: f64,
) -> Result<usize, RunError> {
    if let Some(n) = steps {
        return match n <= MAX_STEPS {
            true => Ok(n),
            false => Err(RunError::new(format!("a run of {n} steps is too long; the limit is {MAX_STEPS}"))),
        };
    }
    let length = until.or(stated_length(lab)).unwrap_or(RUN_LENGTH);
    let text = |x: f64| Value::Number(x).to_string();
    if !(0.0..f64::INFINITY).contains(&length) {
        return Err(RunError::new(format!(
            "a run cannot last {} s; its length is a number of seconds, 0 or more",
            text(length)
        )));
    }
    let count = match until.is_none() && stated_length(lab).is_some() {
        true => StopTime::steps_until(length, timestep),
        false => (length / timestep + 0.5).floor(),
    };
    if !(0.0..=MAX_STEPS as f64).contains(&count) {
        let error = RunError::new(match timestep > 0.0 {
            true => format!(
                "a run of {} s at a timestep of {} s would take {} steps; the limit is {MAX_STEPS}",
                text(length),
                text(timestep),
                text(count)
            ),
            false => format!("the timestep is {} s, so time does not advance", text(timestep)),
        });
        return Err(match length >= LONG_RUN {
            true => error.help("write a shorter time: `stopAt` and `until` are in seconds"),
            false => error,
        });
    }
    Ok(count as usize)
}

/// A run before its first step.
pub(crate) struct StartedRun<'p> {
    pub(crate) session: Session<'p>,
    pub(crate) samples: Samples<'p>,
    /// Number of steps, the time at which the run ends, and the number of steps between two samples.
    pub(crate) steps: usize,
    pub(crate) stop: Option<StopTime>,
    pub(crate) every: usize,
    /// Buttons and the times of their presses, s, in order of time.
    pub(crate) presses: Vec<(usize, f64)>,
    timestep: f64,
}

/// Loads a lab and sets its controls, for programs and monitors that read and write `access`.
///
/// # Errors
/// A control that does not exist, a setting that a student cannot choose, or a run that is too long.
pub(crate) fn begin<'p>(
    lab: &Lab,
    model: &Model,
    programs: &'p Programs,
    options: &RunOptions,
    access: &AccessSet,
) -> Result<StartedRun<'p>, RunError> {
    let all = AccessSet { reads: FieldSet::ALL, ..*access };
    let plan = Plan::new(model, if options.full { &all } else { access });
    let start = Start { plan: Some(plan), ..Start::of_lab(lab) };
    let mut session = Session::start(programs, model, start);
    set_controls(&mut session, lab, programs, &options.set)?;
    let presses = presses(programs, &options.press)?;
    let timestep = session.world.model.opt.timestep;
    let steps = count_steps(lab, options.until, options.steps, timestep)?;
    presses_within(programs, &presses, steps, timestep)?;
    let every = options.every.max(1);
    if (steps / every).saturating_mul(programs.probes.len() + 1) > MAX_CELLS {
        return Err(RunError::new(format!(
            "{steps} steps make the table too large; sample less often with --every"
        )));
    }

    // The inputs of the traces are recorded in columns of numbers, which may be much more than the traces.
    let (_, width) = Samples::new(programs, 0).columns();
    if (steps / every).saturating_mul(width) > 4 * MAX_CELLS {
        return Err(RunError::new(format!(
            "{steps} steps of {width} numbers for the traces are too many; sample less often with --every"
        )));
    }
    let samples = Samples::new(programs, steps / every + 2);
    let most_samples = MAX_CELLS / (programs.probes.len() + 1).max(width / 4);
    let stop = stop_time(lab, options.until, options.steps, steps)
        .map(|stop| StopTime { most: stop.most.min(most_samples.saturating_mul(every)).max(steps), ..stop });
    Ok(StartedRun { session, samples, steps, stop, every, presses, timestep })
}

/// Takes a sample; stops the run when that is not possible.
pub(crate) fn take(samples: &mut Samples<'_>, session: &mut Session<'_>) -> ControlFlow<()> {
    // Programs of another model end the session before its first step, which the table reports.
    let sampled = samples.take(session);
    if sampled.is_err() || samples.text() > MAX_TEXT {
        ControlFlow::Break(())
    } else {
        ControlFlow::Continue(())
    }
}

/// The table of a run after `made` steps.
///
/// # Errors
/// The displayed texts are too long.
pub(crate) fn finish(started: StartedRun<'_>, made: usize) -> Result<Table, RunError> {
    let StartedRun { session, samples, timestep, steps, stop, .. } = started;
    if samples.text() > MAX_TEXT {
        return Err(RunError::new(format!(
            "the texts of the readouts exceed {} MB after {made} steps; display numbers or short texts, or sample less often with --every",
            MAX_TEXT >> 20
        )));
    }
    let mut table = Table::new(timestep, session.probes());
    table.rows = samples.rows();
    table.finish(&session);
    let played = Play { stop, ..Play::steps(steps) };
    table.errors.extend(describe_unreached(&played, &session, made));
    Ok(table)
}

/// Why a run of `made` steps did not end at its stop time, if it was ended before it.
pub(crate) fn describe_unreached(play: &Play<'_>, session: &Session<'_>, made: usize) -> Option<String> {
    let stop = play.stop.filter(|_| play.is_unreached(session, made))?;
    let [stop_at, current] = [stop.time, session.world.data.time()].map(time);
    Some(format!(
        "time does not reach the `stopAt` of {stop_at} s: after {made} steps, the limit, it is {current} s"
    ))
}

/// Runs a lab and samples every trace and readout: at the start, then after every `every` steps and after the last.
///
/// # Errors
/// A control that does not exist, a setting that a student cannot choose, or a run that is too long.
pub fn run(lab: &Lab, model: &Model, programs: &Programs, options: &RunOptions) -> Result<Table, RunError> {
    let mut started = begin(lab, model, programs, options, &programs.access)?;
    let StartedRun { session, samples, steps, stop, every, presses, .. } = &mut started;
    let played = Play { steps: *steps, stop: *stop, every: *every, presses, watched: true };
    let made = play(session, &played, |session, _| take(samples, session));
    finish(started, made)
}
