//! The only loop of runs: presses, steps and samples, in the same order as on a page.

use super::Session;
use std::ops::ControlFlow;

/// How a run is played.
#[derive(Clone, Copy, Debug)]
pub struct Play<'a> {
    /// Number of steps.
    pub steps: usize,
    /// Number of steps between two samples; the last step is sampled too.
    pub every: usize,
    /// Buttons by index, and the times of their presses, s, in order.
    pub presses: &'a [(usize, f64)],
    /// Whether monitors detect silent faults.
    pub watched: bool,
}

impl Play<'_> {
    /// A number of steps, each of them sampled.
    pub const fn steps(steps: usize) -> Play<'static> {
        Play { steps, every: 1, presses: &[], watched: false }
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
    let Play { steps, presses, .. } = *play;
    let every = play.every.max(1);
    let mut pending = presses;
    session.press_due(&mut pending);
    if sample(session, 0).is_break() {
        return 0;
    }
    if play.watched {
        session.watch();
    }
    for made in 1..=steps {
        session.press_due(&mut pending);
        session.step();
        if session.ended().is_some() {
            return made - 1;
        }
        if (made % every == 0 || made == steps) && sample(session, made).is_break() {
            return made;
        }
    }
    steps
}
