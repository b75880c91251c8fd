//! Short lists with a fixed capacity that do not allocate.

/// A list with a capacity of `N` items. Items beyond the capacity are discarded.
#[derive(Clone, Copy)]
pub(crate) struct List<T, const N: usize> {
    items: [T; N],
    len: usize,
}

impl<T: Copy + Default, const N: usize> List<T, N> {
    pub(crate) fn new() -> Self {
        List { items: [T::default(); N], len: 0 }
    }

    pub(crate) fn push(&mut self, item: T) {
        if let Some(place) = self.items.get_mut(self.len) {
            *place = item;
            self.len += 1;
        }
    }

    pub(crate) fn all(&self) -> &[T] {
        &self.items[..self.len]
    }
}
