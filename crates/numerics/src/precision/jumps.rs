//! Runs of the reference of a lab whose controls jump between two steps, such as those of a square wave. The step is split at
//! the time of the jump, so that the new controls apply from there on.

use labspec::run::{Play, Session};
use labspec_core::state;
use labspec_expr::Context;
use std::ops::ControlFlow;

/// The parts of the state that controllers write.
const CONTROLLED_STATE: i32 = state::CTRL | state::QFRC_APPLIED | state::XFRC_APPLIED;
/// The number of bisections that locate a jump up to rounding.
const BISECTIONS: usize = 60;
/// A half of an interval that contains this part of a change may contain a jump.
const JUMP_PART: f64 = 0.8;
/// A change that is larger than the previous one by this factor may be a jump.
const JUMP_FACTOR: f64 = 3.0;

/// Everything on which a step depends.
struct SavedStart {
    state: Vec<f64>,
    context: Context,
}

impl SavedStart {
    fn save(session: &mut Session<'_>) -> SavedStart {
        SavedStart { state: numbers(session, state::INTEGRATION), context: session.context.copy() }
    }

    fn restore(&self, session: &mut Session<'_>) {
        let world = &mut session.world;
        // The state belongs to the same model, so this cannot fail.
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
fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// The values that the controller would write now. The session is unchanged afterwards, except for the counted work.
fn controls_now(session: &mut Session<'_>) -> Vec<f64> {
    let (start, context) = (numbers(session, CONTROLLED_STATE), session.context.copy());
    session.step_by(|_, _| Ok(()));
    let next = numbers(session, CONTROLLED_STATE);
    let world = &mut session.world;
    let _ = state::set(&world.model, &mut world.data, &start, CONTROLLED_STATE);
    session.context = context;
    next
}

fn set_timestep(session: &mut Session<'_>, h: f64) {
    *session.world.model.edit().opt.timestep = h;
}

/// Restores a start, and advances by some time.
fn advance(session: &mut Session<'_>, start: &SavedStart, x: f64) {
    start.restore(session);
    set_timestep(session, x);
    session.step();
    session.refresh();
}

/// The part of a step before the controls jump, or `None` if they do not jump.
fn advance_to_jump(
    session: &mut Session<'_>,
    start: &SavedStart,
    h: f64,
    inputs: &[f64],
    next: &[f64],
) -> Option<f64> {
    let whole = largest_difference(inputs, next);
    let (mut low, mut high) = (0.0, h);
    let (mut at_low, mut at_high) = (inputs.to_vec(), next.to_vec());
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high || high - low <= f64::EPSILON * session.world.data.time() {
            break;
        }
        advance(session, start, middle);
        let current = controls_now(session);
        if session.ended().is_some() {
            return None;
        }
        if largest_difference(&current, &at_high) > JUMP_PART * whole {
            (low, at_low) = (middle, current);
        } else if largest_difference(&at_low, &current) > JUMP_PART * whole {
            (high, at_high) = (middle, current);
        } else {
            return None;
        }
    }
    (high < h && low > 0.0).then_some(high)
}

/// Performs a run as [`labspec::run::play`] does, with steps of constant length that are split where controls jump.
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
        let inputs = numbers(session, CONTROLLED_STATE);
        let next = controls_now(session);
        let change = largest_difference(&inputs, &next);
        if change > JUMP_FACTOR * usual + 1e-9 * largest_difference(&next, &vec![0.0; next.len()]) {
            let end = SavedStart::save(session);
            match advance_to_jump(session, &start, h, &inputs, &next) {
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
