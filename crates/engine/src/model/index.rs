//! Converts ids and addresses of a model, which are signed integers as in MuJoCo's `mjModel`, to indexes.

use std::ops::Range;

/// The elements of a list that belong to an object: `num` elements from the address `adr` on. The address is -1 if there are
/// none.
#[cfg_attr(not(feature = "small"), inline(always))]
pub fn element_range(adr: i32, num: i32) -> Range<usize> {
    debug_assert!(num >= 0 && (adr >= 0 || num == 0), "the {num} elements of an object begin at {adr}");
    let first = adr.max(0) as usize;
    first..first + num as usize
}

/// The index of the object with an id. The id is never -1 (no object), because the referring object requires one.
#[cfg_attr(not(feature = "small"), inline(always))]
pub fn object_index(id: i32) -> usize {
    debug_assert!(id >= 0, "an object that is required has the id {id}");
    id.max(0) as usize
}
