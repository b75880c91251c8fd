//! Collects the items of an iterator in lists, maps and sets. Items are added one by one, which produces the smallest code.

/// Appends an item. Not inlined, so that the module contains this code once for each type.
#[inline(never)]
pub(super) fn put<T>(list: &mut Vec<T>, item: T) {
    list.push(item);
}

/// Collects items in a list, one by one. `collect` reserves memory in advance, and contains the code for the first item twice.
pub(super) fn listed<T>(items: impl IntoIterator<Item = T>) -> Vec<T> {
    let mut out = Vec::new();
    items.into_iter().for_each(|item| put(&mut out, item));
    out
}

/// Collects items in a map or set, one by one. `collect` sorts first, and a sort is much code for each type.
pub(super) fn filled<C: Default + Extend<T>, T>(items: impl IntoIterator<Item = T>) -> C {
    let mut all = C::default();
    all.extend(items);
    all
}
