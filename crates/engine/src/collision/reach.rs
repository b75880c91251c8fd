//! Broad phase of small scenes: which pairs of a list have their bounding spheres in reach, four at a time.
//!
//! A geom is held against four others at once, in the lanes of a vector. Which of them are its pairs, and from which distance on
//! these are out of reach, is found once, when the list is made. A small module leaves it to the test of each pair.

use super::filter::Pair;
use crate::math::sort::sort;
use crate::math::{SMALL, Vec3};
use std::array::from_fn;
use wide::f64x4;

/// The pairs of a list by their bounding spheres.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Spheres {
    /// The geoms whose spheres are compared, and their centres by fours: x, y, z.
    geoms: Vec<u32>,
    centres: Vec<[[f64; 4]; 3]>,
    comparisons: Vec<Comparison>,
    /// A bit for each pair of the list: whether its spheres are not compared, and whether they are in reach now.
    others: Vec<u64>,
    near: Vec<u64>,
}

/// A geom and four others, by their number among the fours.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Comparison {
    geom: u32,
    four: u32,
    /// The squared distance of centres beyond which each is out of reach, and the pair that it makes; [`NONE`] beyond any distance.
    limits: [f64; 4],
    pairs: [u32; 4],
}

/// No pair.
const NONE: u32 = u32::MAX;

impl Spheres {
    /// For pairs with the squared distances of centres beyond which they are out of reach; infinite where spheres say nothing.
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
        let mut comparisons: Vec<Comparison> = Vec::new();
        for (geom, other, pair) in all {
            let (four, lane) = (other / 4, other as usize % 4);
            let free = |c: &Comparison| (c.geom, c.four, c.pairs[lane]) == (geom, four, NONE);
            if !comparisons.last().is_some_and(free) {
                let none = Comparison { geom, four, limits: [f64::NEG_INFINITY; 4], pairs: [NONE; 4] };
                comparisons.push(none);
            }
            if let Some(last) = comparisons.last_mut() {
                (last.limits[lane], last.pairs[lane]) = (limits[pair as usize], pair);
            }
        }
        let centres = vec![[[0.0; 4]; 3]; geoms.len().div_ceil(4)];
        Spheres { near: vec![0; others.len()], geoms, centres, comparisons, others }
    }

    /// Compares them where the geoms are now.
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

    /// How many words there are of a bit for each pair of the list.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(super) fn word_count(&self) -> usize {
        self.others.len()
    }

    /// Takes a word of what may touch: a bit for each pair in reach, and a bit for each whose spheres are not compared.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(super) fn take(&mut self, word: usize) -> [u64; 2] {
        [std::mem::take(&mut self.near[word]), self.others[word]]
    }
}
