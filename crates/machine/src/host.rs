//! The host at run time: reads and stores elements of fields, and calls the functions that the schema describes.

use crate::heap::Heap;
use crate::types::{FieldKey, FunctionId};
use crate::value::Value;

/// The host of running programs. Indexes count from the start of the whole field, as in `Field::first`.
pub trait Host {
    /// Returns element `index`, or `None` past the end.
    fn get(&self, field: FieldKey, index: usize) -> Option<f64>;

    /// Reads several elements into `out`; returns `false` if one of them does not exist. An expression reads all elements that
    /// it needs in one call, sorted by field and index.
    fn read(&self, elements: &[(FieldKey, u32)], out: &mut [f64]) -> bool {
        out.iter_mut().zip(elements).all(|(x, &(field, index))| match self.get(field, index as usize) {
            Some(current) => {
                *x = current;
                true
            }
            None => false,
        })
    }

    /// Stores an element that exists.
    ///
    /// # Errors
    /// The host refuses. The string becomes the message of a `RuntimeError`.
    fn set(&mut self, field: FieldKey, index: usize, value: f64) -> Result<(), String>;

    /// Returns the current number of elements of the whole field.
    fn len(&self, field: FieldKey) -> usize;

    /// Calls a function. Lists and records among the arguments and in the result are objects of `heap`. Arguments for
    /// `Param::Object` are not passed. If optional arguments are omitted, `args` is shorter.
    ///
    /// # Errors
    /// The call fails. The string becomes the message of a `RuntimeError`.
    fn call(&mut self, heap: &mut Heap, function: FunctionId, args: &[Value]) -> Result<Value, String>;

    /// Identifies the model to which field numbers and element indexes refer, as `Schema::identity` does for programs.
    /// Hosts of which there is only one kind may return 0.
    fn identity(&self) -> u64 {
        0
    }

    /// Returns the work of all calls so far, in units of about a nanosecond. It counts as work of the calling program.
    fn work(&self) -> u64 {
        0
    }
}
