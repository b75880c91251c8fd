//! What operations name by number: functions of the text, methods, arrays of the simulation.

use std::sync::Arc;

use crate::types::Elem;
use crate::value::{Value, View};

/// A function of the text.
pub type UnitId = u32;

/// The name of a method: the index of its first row in the table of `natives`. Rows with the same name are adjacent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MethodId(pub(crate) u8);

/// The index of a free function in that table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FreeFunctionId(pub(crate) u8);

/// One member of every object of a collection, by the name of the object.
#[derive(Clone, Debug, PartialEq)]
pub struct MemberTable {
    /// The noun for the objects: `joint`.
    pub noun: String,
    /// Sorted by name.
    pub members: Vec<(Arc<str>, Value)>,
    /// Whether the members are numbers: then the first element of each view is loaded.
    pub scalar: bool,
}

/// An array of the simulation that is used as a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ExposedView {
    /// The array.
    pub view: View,
    /// The type of its elements.
    pub elem: Elem,
    /// Whether its elements can be stored.
    pub assignable: bool,
}
