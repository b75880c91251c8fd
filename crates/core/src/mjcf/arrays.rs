//! Fills arrays of a model with one or more values per object.
//!
//! A model has hundreds of arrays. To keep the code small, the loop is compiled once per type of object, and each array adds only
//! the function that reads its values. Arrays are filled in place: a new list would have to be moved there, and the old one
//! freed.

use super::gather::put;
use super::spec::NumberList;

/// Fills an array with the values of all objects, one object after the other.
pub(super) fn flat<T, V, const N: usize>(
    array: &mut Vec<V>,
    list: impl IntoIterator<Item = T>,
    mut values: impl FnMut(T) -> [V; N],
) {
    refill(array, list.into_iter(), &mut values);
}

#[inline(never)]
fn refill<T, V, const N: usize>(
    array: &mut Vec<V>,
    list: impl Iterator<Item = T>,
    values: &mut dyn FnMut(T) -> [V; N],
) {
    array.clear();
    list.for_each(|x| values(x).into_iter().for_each(|x| put(array, x)));
}

/// Fills an array with `width` user values per object. Missing values are zero.
pub(super) fn padded<'l>(array: &mut Vec<f64>, lists: impl Iterator<Item = &'l NumberList>, width: usize) {
    array.clear();
    lists.for_each(|l| (0..width).for_each(|k| put(array, l.numbers.get(k).copied().unwrap_or(0.0))));
}
