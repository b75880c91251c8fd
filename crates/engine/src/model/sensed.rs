//! A set of elements of `sensordata`.

use std::ops::Range;

/// A set of elements of `sensordata`, by index. The last bit represents all elements that have no bit of their own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Values(pub(crate) [u64; 4]);

impl Values {
    pub(crate) const NONE: Values = Values([0; 4]);
    pub(crate) const ALL: Values = Values([u64::MAX; 4]);
    const BITS: usize = 256;

    fn bits(places: Range<usize>) -> Range<usize> {
        let last = Values::BITS - 1;
        match places.is_empty() {
            true => 0..0,
            false => places.start.min(last)..(places.end - 1).min(last) + 1,
        }
    }

    pub(crate) fn insert(&mut self, places: Range<usize>) {
        Values::bits(places).for_each(|i| self.0[i / 64] |= 1 << (i % 64));
    }

    /// Whether the set contains at least one of these elements.
    pub(crate) fn some(&self, places: Range<usize>) -> bool {
        Values::bits(places).any(|i| self.has(i))
    }

    /// Whether the set contains all of these elements.
    pub(crate) fn every(&self, places: Range<usize>) -> bool {
        Values::bits(places).all(|i| self.has(i))
    }

    fn has(&self, i: usize) -> bool {
        self.0[i / 64] & (1 << (i % 64)) != 0
    }
}
