//! Runs of a reference with a controller whose controls jump between two steps, as those of a square wave do: the step is cut in two
//! at the time of the jump, so that the controls are held from there on.

use labspec::run::{Play, Session};
use labspec_core::state;
use labspec_expr::Context;
use std::ops::ControlFlow;

/// What controllers write.
const WRITTEN: i32 = state::CTRL | state::QFRC_APPLIED | state::XFRC_APPLIED;
/// Halvings of a step that find a jump to rounding.
const HALVINGS: usize = 60;
/// A half of an interval in which this part of a change happens may hold a jump.
const MOST_OF_IT: f64 = 0.8;
/// A change that is this many times the one before may be a jump.
const SUDDEN: f64 = 3.0;

/// All that a step depends on.
struct SavedStart {
    state: Vec<f64>,
    context: Context,
}

impl SavedStart {
    fn save(session: &Session<'_>) -> SavedStart {
        SavedStart { state: numbers(session, state::INTEGRATION), context: session.context.clone() }
    }

    fn restore(&self, session: &mut Session<'_>) {
        let world = &mut session.world;
        // Of the model that it was taken from: nothing can be refused.
        let _ = state::set(&world.model, &mut world.data, &self.state, state::INTEGRATION);
        session.context.clone_from(&self.context);
        session.refresh();
    }
}

fn numbers(session: &Session<'_>, sig: i32) -> Vec<f64> {
    let world = &session.world;
    let mut list = vec![0.0; state::size(&world.model, sig).unwrap_or(0)];
    let _ = state::get(&world.model, &world.data, &mut list, sig);
    list
}

/// The largest difference.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// What the controller would write now. Nothing is left of it but the work.
fn peek(session: &mut Session<'_>) -> Vec<f64> {
    let (start, context) = (numbers(session, WRITTEN), session.context.clone());
    session.step_by(|_, _| Ok(()));
    let next = numbers(session, WRITTEN);
    let world = &mut session.world;
    let _ = state::set(&world.model, &mut world.data, &start, WRITTEN);
    session.context = context;
    next
}

fn set_timestep(session: &mut Session<'_>, h: f64) {
    *session.world.model.edit().opt.timestep = h;
}

/// Goes on from a start for some time.
fn advance(session: &mut Session<'_>, start: &SavedStart, x: f64) {
    start.restore(session);
    set_timestep(session, x);
    session.step();
    session.refresh();
}

/// The part of a step before its controls jump from what they were to what they become; `None` where they do not jump.
fn before_the_jump(
    session: &mut Session<'_>,
    start: &SavedStart,
    h: f64,
    held: &[f64],
    next: &[f64],
) -> Option<f64> {
    let whole = apart(held, next);
    let (mut low, mut high) = (0.0, h);
    let (mut at_low, mut at_high) = (held.to_vec(), next.to_vec());
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high || high - low <= f64::EPSILON * session.world.data.time() {
            break;
        }
        advance(session, start, middle);
        let now = peek(session);
        if session.ended().is_some() {
            return None;
        }
        if apart(&now, &at_high) > MOST_OF_IT * whole {
            (low, at_low) = (middle, now);
        } else if apart(&at_low, &now) > MOST_OF_IT * whole {
            (high, at_high) = (middle, now);
        } else {
            return None;
        }
    }
    (high < h && low > 0.0).then_some(high)
}

/// Plays a run as [`labspec::run::play`] does, with steps of one length that are cut where controls jump.
pub(super) fn play(
    session: &mut Session<'_>,
    play: &Play<'_>,
    h: f64,
    mut sample: impl FnMut(&mut Session<'_>, usize) -> ControlFlow<()>,
) -> usize {
    let mut pending = play.presses;
    session.press_due(&mut pending);
    if sample(session, 0).is_break() {
        return 0;
    }
    let mut usual = 0.0;
    for made in 1..=play.steps {
        session.press_due(&mut pending);
        let start = SavedStart::save(session);
        session.step();
        if session.ended().is_some() {
            return made - 1;
        }
        session.refresh();
        let held = numbers(session, WRITTEN);
        let next = peek(session);
        let change = apart(&held, &next);
        if change > SUDDEN * usual + 1e-9 * apart(&next, &vec![0.0; next.len()]) {
            let end = SavedStart::save(session);
            match before_the_jump(session, &start, h, &held, &next) {
                Some(x) => {
                    advance(session, &start, x);
                    set_timestep(session, h - x);
                    session.step();
                }
                None => {
                    end.restore(session);
                    usual = change;
                }
            }
            set_timestep(session, h);
        } else {
            usual = change;
        }
        if session.ended().is_some() {
            return made - 1;
        }
        if sample(session, made).is_break() {
            return made;
        }
    }
    play.steps
}
