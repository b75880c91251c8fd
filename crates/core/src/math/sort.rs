//! Sorting. The sorts of the standard library are fast, but large, and are compiled once for each type. With the
//! feature `small`, a short heapsort (Williams 1964) replaces them. In the orders that are used no two items compare
//! equal, so both give the same result. Sorts that run only when a model is compiled use [`labspec_finding::order`].

use super::SMALL;
use std::cmp::Ordering;

/// Sorts by an order in which no two items are equal.
pub(crate) fn sort_by<T>(items: &mut [T], mut order: impl FnMut(&T, &T) -> Ordering) {
    if SMALL {
        heap_sort(items, &mut |a, b| order(a, b).is_lt());
    } else {
        items.sort_unstable_by(order);
    }
}

/// Sorts numbers or tuples of numbers. Equal items are indistinguishable, so their order does not matter.
pub(crate) fn sort<T: Ord>(items: &mut [T]) {
    sort_by(items, T::cmp);
}

/// Heapsort. In the heap no item is less than its two children; the children of item k are at 2 k + 1 and 2 k + 2.
/// The first item is the largest: it is swapped to the end, and the remaining items are made a heap again.
fn heap_sort<T>(items: &mut [T], less: &mut dyn FnMut(&T, &T) -> bool) {
    for top in (0..items.len() / 2).rev() {
        sink(items, top, less);
    }
    for end in (1..items.len()).rev() {
        items.swap(0, end);
        sink(&mut items[..end], 0, less);
    }
}

/// Swaps an item with its larger child until no child is larger.
fn sink<T>(heap: &mut [T], mut at: usize, less: &mut dyn FnMut(&T, &T) -> bool) {
    loop {
        let mut below = 2 * at + 1;
        if below + 1 < heap.len() && less(&heap[below], &heap[below + 1]) {
            below += 1;
        }
        if below >= heap.len() || !less(&heap[at], &heap[below]) {
            return;
        }
        heap.swap(at, below);
        at = below;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn as_the_standard_library_sorts(mut items in prop::collection::vec(-20i32..20, 0..60)) {
            let mut numbered: Vec<(i32, usize)> = items.iter().copied().zip(0..).collect();
            let mut stable = numbered.clone();
            heap_sort(&mut numbered, &mut |a, b| a < b);
            stable.sort_by_key(|&(x, _)| x);
            prop_assert_eq!(&numbered, &stable);
            let mut expected = items.clone();
            expected.sort_unstable();
            heap_sort(&mut items, &mut |a, b| a < b);
            prop_assert_eq!(items, expected);
        }
    }
}
