//! The only loop of runs: presses, steps and samples, in the same order as on a page.

use super::Session;
use labspec_core::Warning;
use std::ops::ControlFlow;

/// How a run is played.
#[derive(Clone, Copy, Debug)]
pub struct Play<'a> {
    /// Number of steps. A run with a `stop` takes as many if time advances by the timestep at its start in each.
    pub steps: usize,
    /// The time at which the run ends; if `None`, it ends after `steps`.
    pub stop: Option<StopTime>,
    /// Number of steps between two samples; the last step is sampled too.
    pub every: usize,
    /// Buttons by index, and the times of their presses, s, in order.
    pub presses: &'a [(usize, f64)],
    /// Whether monitors detect silent faults.
    pub watched: bool,
}

/// The time at which a run ends: at the first sample that has reached it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StopTime {
    /// The time, s.
    pub time: f64,
    /// Number of steps after which the run ends although it has not reached this time, because something resets it.
    pub most: usize,
}

/// Maximum length of a run that ends at a time, as a multiple of the steps that it takes if nothing resets it and nothing
/// shortens its timestep.
const MOST_TIMES: usize = 20;

/// Tolerance of the time at which a run ends, in steps.
const ON_TIME: f64 = 1e-9;

impl StopTime {
    /// The end of a run that reaches this time after `steps` if its timestep does not change.
    pub fn after(time: f64, steps: usize) -> StopTime {
        StopTime { time, most: steps.saturating_mul(MOST_TIMES).min(super::MAX_STEPS).max(steps) }
    }

    /// Number of steps of this length up to a time, which may be infinite.
    pub(super) fn steps_until(time: f64, timestep: f64) -> f64 {
        let steps = time / timestep;
        (steps - ON_TIME - rounding(steps, steps)).ceil()
    }

    /// Whether the session has reached this time after `made` steps.
    fn is_reached(self, session: &Session<'_>, made: usize) -> bool {
        let tolerance = ON_TIME * session.world.model.opt.timestep + rounding(made as f64, self.time);
        session.world.data.time() >= self.time - tolerance
    }
}

/// The rounding error of a time that is the sum of `steps` steps.
fn rounding(steps: f64, time: f64) -> f64 {
    steps * f64::EPSILON * time.abs()
}

/// Whether the engine has reset the data of a session because of a bad number, after which time starts again at 0.
fn has_diverged(session: &Session<'_>) -> bool {
    let resets = [Warning::BadQpos, Warning::BadQvel, Warning::BadQacc];
    resets.iter().any(|w| session.warnings.get(*w as usize).is_some_and(|stat| stat.number > 0))
}

impl Play<'_> {
    /// A number of steps, each of them sampled.
    pub const fn steps(steps: usize) -> Play<'static> {
        Play { steps, stop: None, every: 1, presses: &[], watched: false }
    }

    /// Whether the sample after `made` steps is the last one. A run that has diverged is not continued up to its stop time.
    pub fn is_over(&self, session: &Session<'_>, made: usize) -> bool {
        let Some(stop) = self.stop else { return made >= self.steps };
        stop.is_reached(session, made) || made >= stop.most || made >= self.steps && has_diverged(session)
    }

    /// Whether a run of `made` steps was ended before its stop time, because it never reaches it.
    pub fn is_unreached(&self, session: &Session<'_>, made: usize) -> bool {
        let is_unreached = |stop: StopTime| made >= stop.most && !stop.is_reached(session, made);
        self.stop.is_some_and(is_unreached) && !has_diverged(session)
    }
}

/// Plays a run. `sample` is called at the start and after every `every` steps, with the number of steps made; it may stop
/// the run. Returns how many steps were made before the run ended or was stopped. The step in which the run itself ends is
/// not sampled: the displayed values no longer change, or are unknown.
pub fn play(
    session: &mut Session<'_>,
    play: &Play<'_>,
    mut sample: impl FnMut(&mut Session<'_>, usize) -> ControlFlow<()>,
) -> usize {
    let every = play.every.max(1);
    let mut pending = play.presses;
    session.press_due(&mut pending);
    if sample(session, 0).is_break() {
        return 0;
    }
    if play.watched {
        session.watch();
    }
    let mut made = 0;
    let mut is_over = play.is_over(session, made);
    while !is_over {
        session.press_due(&mut pending);
        session.step();
        if session.ended().is_some() {
            return made;
        }
        made += 1;
        is_over = play.is_over(session, made);
        if (made % every == 0 || is_over) && sample(session, made).is_break() {
            return made;
        }
    }
    made
}
