//! Arrays of a model, from one value or more of each object.

use super::spec::List;

/// Numbers of each object, one after the other.
pub(super) fn flat<T, const N: usize>(
    list: impl IntoIterator<Item = T>,
    of: impl Fn(T) -> [f64; N],
) -> Vec<f64> {
    let mut out: Vec<[f64; N]> = Vec::new();
    list.into_iter().map(of).for_each(|x| put(&mut out, x));
    out.into_flattened()
}

/// One integer of each object.
pub(super) fn ints<T>(list: impl IntoIterator<Item = T>, of: impl FnMut(T) -> i32) -> Vec<i32> {
    let mut out = Vec::new();
    list.into_iter().map(of).for_each(|x| put(&mut out, x));
    out
}

/// Appends an item; in the module once, however many lists are made.
#[inline(never)]
fn put<T>(list: &mut Vec<T>, item: T) {
    list.push(item);
}

/// The user values of each object, `width` of them.
pub(super) fn padded<'l>(lists: impl Iterator<Item = &'l List>, width: usize) -> Vec<f64> {
    lists.flat_map(|l| l.numbers.iter().copied().chain(std::iter::repeat(0.0)).take(width)).collect()
}

/// A map or set of items, put in one by one: `collect` sorts first, and a sort is a lot of code for each type.
pub(super) fn filled<C: Default + Extend<T>, T>(items: impl IntoIterator<Item = T>) -> C {
    let mut all = C::default();
    all.extend(items);
    all
}
