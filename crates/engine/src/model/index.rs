//! Ids and addresses of a model, which are signed integers as in MuJoCo's `mjModel`, as indexes.

use std::ops::Range;

/// The elements of a list that belong to an object: `num` from the address `adr` on. An object without any has the address -1.
#[cfg_attr(not(feature = "small"), inline(always))]
pub fn element_range(adr: i32, num: i32) -> Range<usize> {
    debug_assert!(num >= 0 && (adr >= 0 || num == 0), "the {num} elements of an object begin at {adr}");
    let first = adr.max(0) as usize;
    first..first + num as usize
}

/// The index of the object with an id, where -1, no object, is excluded: by the type of what refers to it.
#[cfg_attr(not(feature = "small"), inline(always))]
pub fn object_index(id: i32) -> usize {
    debug_assert!(id >= 0, "an object that is required has the id {id}");
    id.max(0) as usize
}
