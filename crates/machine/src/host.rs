//! The host while a program runs: what reads and stores the elements of fields, and calls the functions that the schema
//! describes.

use crate::heap::Heap;
use crate::types::{FieldKey, FunctionId};
use crate::value::Value;

/// The host while a program runs. Indexes count from the start of the whole field, as `Field::first`.
pub trait Host {
    /// Element `index`; `None` past the end.
    fn get(&self, field: FieldKey, index: usize) -> Option<f64>;

    /// Several elements at once, into as many numbers; `false` when one of them does not exist. This is how an
    /// expression reads everything that it needs, sorted by field and index.
    fn read(&self, elements: &[(FieldKey, u32)], out: &mut [f64]) -> bool {
        out.iter_mut().zip(elements).all(|(x, &(field, index))| match self.get(field, index as usize) {
            Some(now) => {
                *x = now;
                true
            }
            None => false,
        })
    }

    /// Stores an element that exists.
    ///
    /// # Errors
    /// The host refuses: the text becomes the message of a [`crate::runtime_event::RuntimeError`].
    fn set(&mut self, field: FieldKey, index: usize, value: f64) -> Result<(), String>;

    /// Number of elements of the whole field, now.
    fn len(&self, field: FieldKey) -> usize;

    /// Calls a function. Lists and records among the arguments and the result live in `heap`. Arguments for `Param::Object` are not passed; parameters that were left out
    /// make the list shorter.
    ///
    /// # Errors
    /// The call fails: the text becomes the message of a [`crate::runtime_event::RuntimeError`].
    fn call(&mut self, heap: &mut Heap, function: FunctionId, args: &[Value]) -> Result<Value, String>;

    /// What the numbers of fields and elements are of here, as `Schema::identity` says of programs. Hosts of one kind need not
    /// tell.
    fn identity(&self) -> u64 {
        0
    }

    /// The work that calls did so far, in units of about a nanosecond: it counts as work of the program that calls.
    fn work(&self) -> u64 {
        0
    }
}
