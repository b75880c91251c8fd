//! Arrays of a model, from one value or more of each object.
//!
//! There are hundreds of them: in the module the loop is there once for each type of object, and for each array what it takes
//! of an object. They are filled where they are: a list that is made anew has to be moved there, and what was there freed.

use super::gather::put;
use super::spec::List;

/// Values of each object, one after the other.
pub(super) fn flat<T, V, const N: usize>(
    array: &mut Vec<V>,
    list: impl IntoIterator<Item = T>,
    mut of: impl FnMut(T) -> [V; N],
) {
    refill(array, list.into_iter(), &mut of);
}

#[inline(never)]
fn refill<T, V, const N: usize>(
    array: &mut Vec<V>,
    list: impl Iterator<Item = T>,
    of: &mut dyn FnMut(T) -> [V; N],
) {
    array.clear();
    list.for_each(|x| of(x).into_iter().for_each(|x| put(array, x)));
}

/// The user values of each object, `width` of them.
pub(super) fn padded<'l>(array: &mut Vec<f64>, lists: impl Iterator<Item = &'l List>, width: usize) {
    array.clear();
    lists.for_each(|l| (0..width).for_each(|k| put(array, l.numbers.get(k).copied().unwrap_or(0.0))));
}
