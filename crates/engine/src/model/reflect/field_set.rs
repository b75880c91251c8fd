//! Sets of fields, one bit per field.

use super::{FieldId, FieldInfo, NFIELD, data, fields};
use crate::model::sensed::Values;

/// A set of fields. For `sensordata`, it also contains the set of its elements, because each sensor has its own cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FieldSet([u64; NFIELD.div_ceil(64)], Values);

impl Default for FieldSet {
    fn default() -> Self {
        FieldSet::EMPTY
    }
}

impl FieldSet {
    /// No field.
    pub const EMPTY: FieldSet = FieldSet([0; NFIELD.div_ceil(64)], Values::NONE);
    /// Every field.
    pub const ALL: FieldSet = FieldSet([u64::MAX; NFIELD.div_ceil(64)], Values::ALL);

    /// Adds a field.
    pub fn insert(&mut self, f: FieldId) {
        self.insert_elements(f, 0, None);
    }

    /// Adds elements of a field: `count` elements from `first` on, or all that follow. For `sensordata`, only these elements are
    /// added. Any other field is added as a whole.
    pub fn insert_elements(&mut self, f: FieldId, first: usize, count: Option<usize>) {
        self.0[f.0 as usize / 64] |= 1 << (f.0 % 64);
        if f == data::sensordata {
            self.1.insert(first..count.map_or(usize::MAX, |n| first.saturating_add(n)));
        }
    }

    /// Whether an element of a field is in the set.
    pub fn contains_element(&self, f: FieldId, element: usize) -> bool {
        self.contains(f) && (f != data::sensordata || self.1.some(element..element + 1))
    }

    /// The elements of `sensordata` in the set.
    pub(crate) fn sensed_elements(&self) -> Values {
        self.1
    }

    /// Whether the set contains all elements of a field with this number of elements.
    pub fn contains_whole(&self, f: FieldId, numbers: usize) -> bool {
        self.contains(f) && (f != data::sensordata || self.1.every(0..numbers))
    }

    /// Whether the field is in the set.
    pub fn contains(&self, f: FieldId) -> bool {
        self.0[f.0 as usize / 64] & (1 << (f.0 % 64)) != 0
    }

    /// Adds all fields of another set.
    pub fn extend(&mut self, other: &FieldSet) {
        for (a, b) in self.0.iter_mut().chain(&mut self.1.0).zip(other.0.iter().chain(&other.1.0)) {
            *a |= b;
        }
    }

    /// The fields of this set that are in another.
    pub fn intersection(&self, other: &FieldSet) -> FieldSet {
        let mut both = *self;
        for (a, b) in both.0.iter_mut().chain(&mut both.1.0).zip(other.0.iter().chain(&other.1.0)) {
            *a &= b;
        }
        both
    }

    /// The fields of this set that are not in another.
    pub fn difference(&self, other: &FieldSet) -> FieldSet {
        let mut rest = *self;
        for (a, b) in rest.0.iter_mut().chain(&mut rest.1.0).zip(other.0.iter().chain(&other.1.0)) {
            *a &= !b;
        }
        rest
    }

    /// Whether no field is in the set.
    pub fn is_empty(&self) -> bool {
        self.0.iter().all(|&bits| bits == 0)
    }

    /// The fields of the set, in table order.
    pub fn iter(&self) -> impl Iterator<Item = FieldId> + '_ {
        fields().filter(|&f| self.contains(f))
    }

    /// Whether every field of this set is in another.
    pub fn is_part_of(&self, other: &FieldSet) -> bool {
        self.0.iter().chain(&self.1.0).zip(other.0.iter().chain(&other.1.0)).all(|(a, b)| a & !b == 0)
    }

    /// Whether any field of the set satisfies `test`.
    pub fn any(&self, mut test: impl FnMut(&FieldInfo) -> bool) -> bool {
        self.iter().any(|f| test(f.info()))
    }
}
