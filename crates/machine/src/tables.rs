//! What operations name by number: functions of the text, methods, arrays of the simulation.

use std::sync::Arc;

use crate::types::Elem;
use crate::value::{Value, View};

/// A function of the text.
pub type UnitId = u32;

/// A name that is a method of something: its first row in the table of `natives`. Rows of one name follow each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MethodId(pub(crate) u8);

/// A function that belongs to nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FreeFunctionId(pub(crate) u8);

/// One member of every object of a collection, by the name of the object.
#[derive(Clone, Debug, PartialEq)]
pub struct MemberTable {
    /// What the objects are called: `joint`.
    pub noun: String,
    /// Sorted by name.
    pub of: Vec<(Arc<str>, Value)>,
    /// The members are numbers: the first element of each view is loaded.
    pub scalar: bool,
}

/// An array of the simulation that becomes a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ExposedView {
    /// The array.
    pub view: View,
    /// What its elements are.
    pub elem: Elem,
    /// Whether its elements can be stored.
    pub assignable: bool,
}
