//! A model and its data, which programs work with.

use super::embedded::Functions;
use labspec_core::{self as core, Data, Error, Model, Planned};
use labspec_expr::{FieldKey, Value};

/// A model and its data during a run.
#[derive(Clone, Debug)]
pub struct World {
    /// The model; controls may write to it.
    pub model: Model,
    /// The state and the fields that depend on it.
    pub data: Data<Planned>,
    /// The keyframe of a reset.
    pub key: Option<usize>,
    /// Functions of the embedding program.
    pub functions: Functions,
    /// The currently displayed values, in the order of the labels of
    /// [`DisplayedLabels`](super::DisplayedLabels), if programs read them.
    pub displayed: Vec<Value>,
    /// Numbers that belong to no field, which programs read under [`NUMBERS`]: the members of sweeps.
    pub numbers: Vec<f64>,
    /// What programs have asked of the page since it last asked for it.
    pub playback: Option<Playback>,
}

/// What a program asks of the page: `sim.play()`, `sim.pause()`, `sim.toggle()`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Playback {
    /// Play.
    Play,
    /// Pause.
    Pause,
    /// Play if the page is paused, otherwise pause.
    Toggle,
}

impl Playback {
    /// The request that is left after `before` and this one. Two toggles cancel each other.
    fn after(self, before: Option<Playback>) -> Option<Playback> {
        match (self, before) {
            (Playback::Toggle, Some(Playback::Play)) => Some(Playback::Pause),
            (Playback::Toggle, Some(Playback::Pause)) => Some(Playback::Play),
            (Playback::Toggle, Some(Playback::Toggle)) => None,
            (asked, _) => Some(asked),
        }
    }

    /// The request as one word.
    pub fn as_str(self) -> &'static str {
        match self {
            Playback::Play => "play",
            Playback::Pause => "pause",
            Playback::Toggle => "toggle",
        }
    }
}

/// The key under which [`World::numbers`] are read.
pub const NUMBERS: FieldKey = FieldKey(u32::MAX);

impl World {
    /// Asks the page to play or to pause.
    pub(super) fn ask_playback(&mut self, asked: Playback) {
        self.playback = asked.after(self.playback);
    }

    /// Resets the simulation to a keyframe, or to the default configuration.
    ///
    /// # Errors
    /// Returns the error of the engine.
    pub fn reset_to(&mut self, key: Option<usize>) -> Result<(), Error> {
        match key.and_then(|k| self.model.keys().nth(k)) {
            Some(key) => core::reset_data_keyframe(&self.model, &mut self.data, key),
            None => core::reset_data(&self.model, &mut self.data),
        }
    }
}
