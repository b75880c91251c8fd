//! A model and its data, which programs work with.

use super::embedded::Functions;
use labspec_core::{self as core, Data, Error, Model, Planned};
use labspec_expr::{FieldKey, Value};

/// A model and its data, while a lab runs.
#[derive(Clone, Debug)]
pub struct World {
    /// The model; controls write to it.
    pub model: Model,
    /// The state and what follows from it.
    pub data: Data<Planned>,
    /// The keyframe to return to.
    pub key: Option<usize>,
    /// Functions of the embedding program.
    pub functions: Functions,
    /// What is shown now, in the order of [`DisplayedLabels`](super::DisplayedLabels)'s labels, where somebody asks.
    pub displayed: Vec<Value>,
    /// Numbers of no field, which texts read under [`NUMBERS`]: the members of sweeps.
    pub numbers: Vec<f64>,
}

/// The key under which [`World::numbers`] are read.
pub const NUMBERS: FieldKey = FieldKey(u32::MAX);

impl World {
    /// Back to a keyframe, or to the default configuration.
    ///
    /// # Errors
    /// What the engine says.
    pub fn reset_to(&mut self, key: Option<usize>) -> Result<(), Error> {
        match key.and_then(|k| self.model.keys().nth(k)) {
            Some(key) => core::reset_data_keyframe(&self.model, &mut self.data, key),
            None => core::reset_data(&self.model, &mut self.data),
        }
    }
}
