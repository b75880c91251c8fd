//! The last steps of a run, which can be repeated with other lengths.

use labspec::run::Session;
use labspec_core::{self as core, Model, state};

/// The part of the state that evolves in a step, and the part that is constant during it.
const MOTION: i32 = state::FULLPHYSICS | state::WARMSTART;
const HELD_INPUTS: i32 = state::USER;
/// The number of stored states.
const MOST_STATES: usize = 4;

/// A state at the end of a step, with the values that were constant in that step.
#[derive(Clone, Debug, Default)]
struct PastState {
    time: f64,
    motion: Vec<f64>,
    held: Vec<f64>,
}

/// The last states of a run, the newest first.
#[derive(Clone, Debug)]
pub(super) struct StepHistory {
    states: [PastState; MOST_STATES],
    count: usize,
}

impl StepHistory {
    pub(super) fn new(m: &Model) -> StepHistory {
        let zeros = |sig| vec![0.0; state::size(m, sig).unwrap_or(0)];
        let empty = PastState { time: 0.0, motion: zeros(MOTION), held: zeros(HELD_INPUTS) };
        StepHistory { states: std::array::from_fn(|_| empty.clone()), count: 0 }
    }

    /// Stores the current state with its time.
    pub(super) fn keep(&mut self, session: &Session<'_>, time: f64) {
        self.states.rotate_right(1);
        let (m, d) = (&session.world.model, &session.world.data);
        let [current, ..] = &mut self.states;
        current.time = time;
        // The state belongs to the same model, so this cannot fail.
        let _ = state::get(m, d, &mut current.motion, MOTION);
        let _ = state::get(m, d, &mut current.held, HELD_INPUTS);
        self.count = (self.count + 1).min(MOST_STATES);
    }

    /// The number of stored states.
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// The time of a state, s.
    pub(super) fn time(&self, j: usize) -> f64 {
        self.states.get(j).map_or(f64::NAN, |s| s.time)
    }

    /// The length of the step that begins at a state.
    pub(super) fn step(&self, j: usize) -> f64 {
        self.time(j.saturating_sub(1)) - self.time(j)
    }
}

/// Evaluates a target in a session.
pub(super) type Evaluate<'e> = dyn Fn(&mut Session<'_>, usize) -> f64 + 'e;

/// A copy of a run in which its last steps are repeated.
pub(super) struct StepReplay<'b> {
    pub(super) session: Session<'b>,
    pub(super) history: &'b StepHistory,
    /// The largest magnitude of the evaluated values.
    pub(super) size: f64,
}

impl<'b> StepReplay<'b> {
    pub(super) fn new(session: &Session<'b>, history: &'b StepHistory) -> StepReplay<'b> {
        StepReplay { session: session.clone(), history, size: 0.0 }
    }

    /// Advances from a state by a step of this length, and computes all fields there.
    pub(super) fn place(&mut self, from: usize, x: f64) {
        let Some(start) = self.history.states.get(from) else { return };
        // The values that were constant in the step are stored with its end.
        let Some(end) = self.history.states.get(from.saturating_sub(1)) else { return };
        let world = &mut self.session.world;
        if x > 0.0 {
            *world.model.edit().opt.timestep = x;
        }
        let (m, d) = (&world.model, &mut world.data);
        let _ = state::set(m, d, &start.motion, MOTION);
        let _ = state::set(m, d, &end.held, HELD_INPUTS);
        if x > 0.0 {
            let _ = core::step(m, d);
        }
        let _ = core::forward(m, d);
    }

    /// The value of a target at a time after a state.
    pub(super) fn value(&mut self, from: usize, x: f64, target: usize, evaluate: &Evaluate<'_>) -> f64 {
        self.place(from, x);
        let value = evaluate(&mut self.session, target);
        if value.is_finite() {
            self.size = self.size.max(value.abs());
        }
        value
    }
}
