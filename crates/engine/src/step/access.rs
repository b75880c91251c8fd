//! What programs read and write of a model and its data: what plans are made for.

use crate::model::reflect::FieldSet;

/// What programs read and write.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AccessSet {
    /// Fields that are read between steps.
    pub reads: FieldSet,
    /// Fields that are written between steps.
    pub writes: FieldSet,
}

impl AccessSet {
    /// Anything may be read or written: what an embedding program gets that says nothing.
    pub const ANY: AccessSet = AccessSet { reads: FieldSet::ALL, writes: FieldSet::ALL };
    /// Anything may be read, only state and controls are written.
    pub const OBSERVE: AccessSet = AccessSet { reads: FieldSet::ALL, writes: FieldSet::EMPTY };
}
