//! Broad phase for small scenes: tests the bounding spheres of the pairs of a list, four at a time.
//!
//! A geom is compared with four others at once, in SIMD lanes. The assignment of pairs to lanes and the distance
//! limits are computed once, when the list is created. Builds with the feature `small` skip this and test each pair
//! separately.

use super::filter::Pair;
use crate::math::sort::sort;
use crate::math::{SMALL, Vec3};
use std::array::from_fn;
use wide::f64x4;

/// The bounding spheres of the pairs of a list.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Spheres {
    /// The geoms whose spheres are compared, and their centres in groups of four: x, y, z.
    geoms: Vec<u32>,
    centres: Vec<[[f64; 4]; 3]>,
    comparisons: Vec<GroupComparison>,
    /// One bit for each pair of the list: pairs whose spheres are not compared, and pairs that are currently in
    /// reach.
    others: Vec<u64>,
    near: Vec<u64>,
}

/// A geom and a group of four others, by the index of the group.
#[derive(Clone, Copy, Debug, PartialEq)]
struct GroupComparison {
    geom: u32,
    four: u32,
    /// For each lane, the squared distance of the centres above which the pair is out of reach, and the index of the
    /// pair. Unused lanes have the limit -∞ and the index [`NONE`].
    limits: [f64; 4],
    pairs: [u32; 4],
}

/// Marks a lane without a pair.
const NONE: u32 = u32::MAX;

impl Spheres {
    /// Prepares the comparisons. `limits` contains, for each pair, the squared distance of the centres above which it
    /// is out of reach; infinity if its spheres are not to be compared.
    pub(super) fn new(pairs: &[Pair], limits: &[f64]) -> Spheres {
        let is_compared = |&p: &usize| !SMALL && limits[p] < f64::INFINITY;
        let mut others = vec![0; pairs.len().div_ceil(64)];
        (0..pairs.len()).filter(|p| !is_compared(p)).for_each(|p| others[p / 64] |= 1 << (p % 64));
        if SMALL {
            return Spheres { near: vec![0; others.len()], others, ..Spheres::default() };
        }
        let compared = || (0..pairs.len()).filter(is_compared);
        let mut geoms: Vec<u32> = compared().flat_map(|p| [pairs[p].geom1, pairs[p].geom2]).collect();
        sort(&mut geoms);
        geoms.dedup();
        let place = |geom: u32| geoms.partition_point(|&g| g < geom) as u32;
        let ordered = |p: usize| {
            let (a, b) = (pairs[p].geom1, pairs[p].geom2);
            (a.min(b), place(a.max(b)), p as u32)
        };
        let mut all: Vec<(u32, u32, u32)> = compared().map(ordered).collect();
        sort(&mut all);
        let mut comparisons: Vec<GroupComparison> = Vec::new();
        for (geom, other, pair) in all {
            let (four, lane) = (other / 4, other as usize % 4);
            let free = |c: &GroupComparison| (c.geom, c.four, c.pairs[lane]) == (geom, four, NONE);
            if !comparisons.last().is_some_and(free) {
                let none = GroupComparison { geom, four, limits: [f64::NEG_INFINITY; 4], pairs: [NONE; 4] };
                comparisons.push(none);
            }
            if let Some(last) = comparisons.last_mut() {
                (last.limits[lane], last.pairs[lane]) = (limits[pair as usize], pair);
            }
        }
        let centres = vec![[[0.0; 4]; 3]; geoms.len().div_ceil(4)];
        Spheres { near: vec![0; others.len()], geoms, centres, comparisons, others }
    }

    /// Compares the spheres at the current positions of the geoms.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(super) fn compare(&mut self, places: &[Vec3]) {
        if !SMALL && !self.comparisons.is_empty() {
            self.compare_all(places);
        }
    }

    #[inline(never)]
    fn compare_all(&mut self, places: &[Vec3]) {
        for (four, geoms) in self.centres.iter_mut().zip(self.geoms.chunks(4)) {
            for (lane, &geom) in geoms.iter().enumerate() {
                let [x, y, z] = places[geom as usize];
                (four[0][lane], four[1][lane], four[2][lane]) = (x, y, z);
            }
        }
        for c in &self.comparisons {
            let (centre, four) = (&places[c.geom as usize], &self.centres[c.four as usize]);
            let [x, y, z]: [f64x4; 3] = from_fn(|k| f64x4::new(four[k]) - centre[k]);
            let far = (x * x + y * y + z * z).simd_gt(f64x4::new(c.limits));
            let mut near = !far.to_bitmask() & 0xf;
            while let Some(&pair) = c.pairs.get(near.trailing_zeros() as usize) {
                near &= near - 1;
                if let Some(word) = self.near.get_mut(pair as usize / 64) {
                    *word |= 1 << (pair % 64);
                }
            }
        }
    }

    /// The number of 64-bit words that hold one bit for each pair of the list.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(super) fn word_count(&self) -> usize {
        self.others.len()
    }

    /// Returns and clears one word of results: a bit for each pair in reach, and a bit for each pair whose spheres
    /// are not compared.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(super) fn take(&mut self, word: usize) -> [u64; 2] {
        [std::mem::take(&mut self.near[word]), self.others[word]]
    }
}
