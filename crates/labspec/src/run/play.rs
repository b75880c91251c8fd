//! The one loop of every run: presses, steps and samples, in the order in which a page has them.

use super::Session;
use std::ops::ControlFlow;

/// How a run is played.
#[derive(Clone, Copy, Debug)]
pub struct Play<'a> {
    /// Number of steps.
    pub steps: usize,
    /// A sample after every so many steps, and after the last one.
    pub every: usize,
    /// Buttons by index, and the times in s at which they are pressed, in order.
    pub presses: &'a [(usize, f64)],
    /// Watches for energy that nothing gave.
    pub watched: bool,
}

impl Play<'_> {
    /// So many steps, each of them sampled, and nothing else.
    pub const fn steps(steps: usize) -> Play<'static> {
        Play { steps, every: 1, presses: &[], watched: false }
    }
}

/// Plays a run: `sample` sees the start, then the lab after every so many steps, with the number of steps made; it may
/// break the run off. Returns how many steps were made before the run ended, by itself or by `sample`. The step in which it
/// ends by itself is not sampled: what the page shows does not change any more, or is not known.
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
