//! Lists, maps and sets from what an iterator gives: one by one, as that is the least code.

/// Appends an item; in the module once, however many lists are made.
#[inline(never)]
pub(super) fn put<T>(list: &mut Vec<T>, item: T) {
    list.push(item);
}

/// The items, put in one by one: `collect` makes room for what will come, and has the code that finds the first item twice.
pub(super) fn listed<T>(items: impl IntoIterator<Item = T>) -> Vec<T> {
    let mut out = Vec::new();
    items.into_iter().for_each(|item| put(&mut out, item));
    out
}

/// A map or set of items, put in one by one: `collect` sorts first, and a sort is a lot of code for each type.
pub(super) fn filled<C: Default + Extend<T>, T>(items: impl IntoIterator<Item = T>) -> C {
    let mut all = C::default();
    all.extend(items);
    all
}
