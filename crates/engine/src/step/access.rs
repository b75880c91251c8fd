//! The fields of a model and its data that programs read and write. Plans are made for such a set.

use crate::model::reflect::FieldSet;

/// The fields that programs read and write.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AccessSet {
    /// Fields that are read between steps.
    pub reads: FieldSet,
    /// Fields that are written between steps.
    pub writes: FieldSet,
}

impl AccessSet {
    /// Any field may be read or written. This is the default for embedding programs.
    pub const ANY: AccessSet = AccessSet { reads: FieldSet::ALL, writes: FieldSet::ALL };
    /// Any field may be read. Only state and controls are written.
    pub const OBSERVE: AccessSet = AccessSet { reads: FieldSet::ALL, writes: FieldSet::EMPTY };
}
