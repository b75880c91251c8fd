//! Arrays of a model, from one value or more of each object.
//!
//! There are hundreds of them: in the module the loop is there once for each type of object, and for each array what it takes
//! of an object.

use super::gather::put;
use super::spec::List;

/// Numbers of each object, one after the other.
pub(super) fn flat<T, const N: usize>(
    list: impl IntoIterator<Item = T>,
    of: impl Fn(T) -> [f64; N],
) -> Vec<f64> {
    numbers(list.into_iter(), &of)
}

#[inline(never)]
fn numbers<T, const N: usize>(list: impl Iterator<Item = T>, of: &dyn Fn(T) -> [f64; N]) -> Vec<f64> {
    let mut out = Vec::new();
    list.for_each(|x| of(x).into_iter().for_each(|x| put(&mut out, x)));
    out
}

/// One integer of each object.
pub(super) fn ints<T>(list: impl IntoIterator<Item = T>, mut of: impl FnMut(T) -> i32) -> Vec<i32> {
    integers(list.into_iter(), &mut of)
}

#[inline(never)]
fn integers<T>(list: impl Iterator<Item = T>, of: &mut dyn FnMut(T) -> i32) -> Vec<i32> {
    let mut out = Vec::new();
    list.for_each(|x| put(&mut out, of(x)));
    out
}

/// The user values of each object, `width` of them.
pub(super) fn padded<'l>(lists: impl Iterator<Item = &'l List>, width: usize) -> Vec<f64> {
    let mut out = Vec::new();
    lists.for_each(|l| (0..width).for_each(|k| put(&mut out, l.numbers.get(k).copied().unwrap_or(0.0))));
    out
}
