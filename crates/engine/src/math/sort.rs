//! Sorting. The standard library's sorts are fast and large, and there is a copy for each type; where a module shall be small
//! (WebAssembly, feature `small`), items are moved past their neighbours, and where that takes long, a heap sorts them (Williams
//! 1964). No two items are equal in the orders that are asked for, so both give the same. What runs once, when a model is compiled, is sorted by [`labspec_finding::order`].

use super::SMALL;
use std::cmp::Ordering;

/// Whether copies of the sort shall be small.
const SHORT: bool = SMALL || cfg!(target_arch = "wasm32");

/// How many places items move on average before a heap takes over: what 64 items in no order need, or any number that is nearly
/// in order, as bounds of bodies are from step to step.
const MOVES: usize = 16;

/// Sorts by an order in which no two items are equal.
pub(crate) fn sort_by<T>(items: &mut [T], mut order: impl FnMut(&T, &T) -> Ordering) {
    if SHORT {
        short_sort(items, &mut |a, b| order(a, b).is_lt());
    } else {
        items.sort_unstable_by(order);
    }
}

/// Sorts numbers or tuples of numbers. Equal items are indistinguishable, so their order does not matter.
pub(crate) fn sort<T: Ord>(items: &mut [T]) {
    sort_by(items, T::cmp);
}

fn short_sort<T>(items: &mut [T], less: &mut dyn FnMut(&T, &T) -> bool) {
    let mut moves = MOVES * items.len();
    for end in 1..items.len() {
        let mut index = end;
        while index > 0 && less(&items[index], &items[index - 1]) {
            items.swap(index, index - 1);
            index -= 1;
            moves -= 1;
            if moves == 0 {
                return heap_sort(items, less);
            }
        }
    }
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
fn sink<T>(heap: &mut [T], mut index: usize, less: &mut dyn FnMut(&T, &T) -> bool) {
    loop {
        let mut below = 2 * index + 1;
        if below + 1 < heap.len() && less(&heap[below], &heap[below + 1]) {
            below += 1;
        }
        if below >= heap.len() || !less(&heap[index], &heap[below]) {
            return;
        }
        heap.swap(index, below);
        index = below;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn as_the_standard_library_sorts(mut items in prop::collection::vec(-20i32..20, 0..200)) {
            let mut numbered: Vec<(i32, usize)> = items.iter().copied().zip(0..).collect();
            let mut stable = numbered.clone();
            heap_sort(&mut numbered, &mut |a, b| a < b);
            stable.sort_by_key(|&(x, _)| x);
            prop_assert_eq!(&numbered, &stable);
            let mut expected = items.clone();
            expected.sort_unstable();
            let mut moved = items.clone();
            heap_sort(&mut items, &mut |a, b| a < b);
            prop_assert_eq!(&items, &expected);
            short_sort(&mut moved, &mut |a, b| a < b);
            prop_assert_eq!(moved, expected);
        }
    }
}
