//! Sorting for code that runs rarely. The standard library's sort is compiled for each type, and takes 5 kB of a WebAssembly
//! module each time. Here, one copy sorts indices for all types.

use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};

/// Sorts by an order; the sort is stable.
pub fn sort_by<T>(items: &mut [T], mut order: impl FnMut(&T, &T) -> Ordering) {
    let mut sources = sorted_indices(items.len(), &mut |i, j| match (items.get(i), items.get(j)) {
        (Some(a), Some(b)) => order(a, b),
        _ => Ordering::Equal,
    });
    arrange(&mut sources, &mut |i, j| items.swap(i, j));
}

/// Sorts by a key; the sort is stable.
pub fn sort_by_key<T, K: Ord>(items: &mut [T], key: impl Fn(&T) -> K) {
    sort_by(items, |a, b| key(a).cmp(&key(b)));
}

/// A set of items. What is collected into a set is sorted first, by a copy of the sort for its type; here it is inserted.
pub fn set<T: Ord>(items: impl IntoIterator<Item = T>) -> BTreeSet<T> {
    let mut set = BTreeSet::new();
    set.extend(items);
    set
}

/// A map of pairs, as [`set`]; of equal keys the last one counts.
pub fn map<K: Ord, V>(pairs: impl IntoIterator<Item = (K, V)>) -> BTreeMap<K, V> {
    let mut map = BTreeMap::new();
    map.extend(pairs);
    map
}

fn sorted_indices(count: usize, order: &mut dyn FnMut(usize, usize) -> Ordering) -> Vec<usize> {
    let mut indices: Vec<usize> = (0..count).collect();
    indices.sort_by(|i, j| order(*i, *j));
    indices
}

/// Applies a permutation by swaps along its cycles; `sources[i]` is the index of the item for place `i`.
fn arrange(sources: &mut [usize], swap: &mut dyn FnMut(usize, usize)) {
    for start in 0..sources.len() {
        let mut place = start;
        while let Some(source) = sources.get_mut(place) {
            let next = std::mem::replace(source, place);
            if next == start || next == place {
                break;
            }
            swap(place, next);
            place = next;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All lists of up to six small numbers.
    #[test]
    fn sorted_as_the_standard_library_sorts() {
        for length in 0..=6_u32 {
            for code in 0..3_u32.pow(length) {
                let digit = |place: u32| code / 3_u32.pow(place) % 3;
                let mut items: Vec<(u32, u32)> = (0..length).map(|place| (digit(place), place)).collect();
                let mut expected = items.clone();
                expected.sort_by_key(|(key, _)| *key);
                sort_by_key(&mut items, |(key, _)| *key);
                assert_eq!(items, expected);
            }
        }
    }
}
