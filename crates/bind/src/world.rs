//! The engine as the language's host: fields are read and written by id and flat index.

use super::functions;
use super::own::{self, Functions};
use labspec_core::reflect::FieldId;
use labspec_core::{self as core, Data, Error, Model, Planned};
use labspec_expr::{FieldKey, FunctionId, Heap, Host, Value};

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
    pub own: Functions,
    /// What is shown now, in the order of [`Shown`](super::Shown)'s labels, where somebody asks.
    pub shown: Vec<Value>,
    /// Numbers of no field, which texts read under [`NUMBERS`]: the members of sweeps.
    pub numbers: Vec<f64>,
}

/// The key under which [`World::numbers`] are read.
pub const NUMBERS: FieldKey = FieldKey(u32::MAX);

impl Host for World {
    #[inline]
    fn get(&self, FieldKey(f): FieldKey, index: usize) -> Option<f64> {
        match FieldId::new(f as usize) {
            Some(field) => core::element(&self.model, &self.data, field, index),
            None => self.numbers.get(index).copied(),
        }
    }

    fn set(&mut self, FieldKey(f): FieldKey, index: usize, value: f64) -> Result<(), String> {
        let field = FieldId::new(f as usize).ok_or("there is no such field")?;
        check(field, value)?;
        core::view_mut(&mut self.model, &mut self.data, field)?.set(index, value);
        Ok(())
    }

    fn len(&self, FieldKey(f): FieldKey) -> usize {
        FieldId::new(f as usize).map_or(self.numbers.len(), |f| core::length(&self.model, &self.data, f))
    }

    fn call(&mut self, heap: &mut Heap, FunctionId(f): FunctionId, args: &[Value]) -> Result<Value, String> {
        match functions::TABLE.get(f as usize) {
            Some(function) => {
                let before = core::cost(&self.data);
                let result = functions::access::call(function.run, self, heap, args);
                // Passes of the engine have counted themselves.
                let price =
                    if core::cost(&self.data) == before { functions::price(function, self) } else { 0 };
                core::charge(&mut self.data, price);
                result
            }
            None => {
                core::charge(&mut self.data, own::PRICE);
                let called =
                    (f as usize).checked_sub(functions::TABLE.len()).and_then(|at| self.own.call(at, args));
                called.unwrap_or_else(|| Err("there is no such function".into()))
            }
        }
    }

    fn identity(&self) -> u64 {
        self.model.identity()
    }

    fn work(&self) -> u64 {
        core::cost(&self.data)
    }
}

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

/// Values that the engine has no meaning for are refused, not ignored.
fn check(field: FieldId, value: f64) -> Result<(), String> {
    let refused = |known: &str| Err(format!("`{}` cannot be {value}: {known}", field.info().name));
    let is = |allowed: &[i32]| allowed.iter().any(|&a| f64::from(a) == value);
    match field.info().name {
        "timestep" if !(value > 0.0 && value.is_finite()) => {
            Err(format!("the timestep must be greater than 0, not {value}"))
        }
        "integrator" if !is(&[0, 1, 2, 3, 4]) => {
            refused("0 is Euler, 1 RK4, 2 implicit, 3 implicitfast, 4 discrete")
        }
        "cone" if !is(&[0, 1]) => refused("0 is pyramidal, 1 elliptic"),
        "solver" if !is(&[0, 1, 2]) => refused("0 is PGS, 1 CG, 2 Newton"),
        "geom_condim" if !is(&[1, 3, 4, 6]) => {
            refused("1 is frictionless, 3 slides, 4 also twists, 6 also rolls")
        }
        _ => Ok(()),
    }
}
