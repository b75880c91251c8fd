//! The Hessian of an island, M + Jᵀ C J, and its factorization H = L Lᵀ.
//!
//! The lower triangle is kept in blocks of four by four, the lanes of a vector. Each row of blocks is kept from its first
//! block that is not zero up to the diagonal; L fills nothing outside of that (George and Liu 1981, *Computer Solution of
//! Large Sparse Positive Definite Systems*, ch. 4). Each tree comes from its leaves to its root, so that its branches do not meet
//! before the bodies that carry them. In large islands, where most pairs of trees do not touch, trees are ordered so that
//! rows are short: breadth first from an end of the island, reversed (Cuthill and McKee 1969, George 1971).

mod tree_order;

use super::island::Islands;
use super::jacobian::{HessianAccumulator, Jacobian};
use crate::dynamics::mass;
use crate::math::lanes::total;
use crate::math::{self, MINVAL, broken_invariant};
use crate::model::Model;
use std::array::from_fn;
use std::ops::Range;
use tree_order::Order;
use wide::f64x4;

/// Degrees of freedom up to which trees stay in the order of the file.
const SMALL: usize = 120;

/// The sum of the squares of the lengths of rows up to which an island is solved with its Hessian: that of a thousand
/// degrees of freedom, each tied to each. Beyond that a step would take minutes; conjugate gradients find the same
/// solution without it.
const MOST_WORK: usize = 330_000_000;

/// Four numbers of a row that follow each other, and a block of four by four, row by row.
type Four = [f64; 4];
type Tile = [Four; 4];

/// A symmetric matrix: the lower triangle, by rows of blocks. Rows that fill the last one up are those of the identity.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Hessian {
    /// Position of each degree of freedom of the model in its island.
    pub(super) local: Vec<u32>,
    values: Vec<Tile>,
    /// Inverse diagonal of L.
    inverse: Vec<Four>,
    blocks: Vec<BlockRow>,
    /// Number of rows without those that fill up.
    len: usize,
    /// What the layout was made for: how many times islands had been found, the island, and whether there is room.
    made_for: (u64, usize),
    fits: bool,
    /// What a factorization costs.
    pub(super) work: u64,
    /// The first column of each row.
    first: Vec<u32>,
    /// Where the numbers of M go, those of the island row by row.
    mass: Vec<u32>,
    /// The columns of the blocks of the Jacobian, where they are here, and how many of these blocks have been passed.
    column_blocks: Vec<ColumnBlocks>,
    listed_columns: Vec<u32>,
    lanes: Vec<ColumnBlock>,
    passed: usize,
    /// Scratch of a block of the Jacobian: its rows by fours of columns.
    fours: Vec<Four>,
    order: Order,
    /// How many times it was laid out.
    #[cfg(test)]
    pub(super) laid_out: usize,
}

/// Four rows: their first block, and where it lies.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct BlockRow {
    first: usize,
    start: usize,
}

/// Where columns of a block of the Jacobian, or of several that follow each other, are listed, and the fours that they are among.
#[derive(Clone, Debug, PartialEq)]
struct ColumnBlocks {
    columns: Range<usize>,
    lanes: Range<usize>,
}

/// Four columns that a block of H begins with: which column of a block of the Jacobian each is, or [`NONE`].
#[derive(Clone, Copy, Debug, PartialEq)]
struct ColumnBlock {
    block: u32,
    of: [u32; 4],
}

/// No column.
const NONE: u32 = u32::MAX;

impl Hessian {
    /// The island that it is laid out for.
    pub(super) fn island(&self) -> usize {
        self.made_for.1
    }

    /// Number of entries of a vector.
    pub(super) fn capacity(&self) -> usize {
        4 * self.blocks.len()
    }

    /// Numbers of the matrix that are kept.
    #[cfg(test)]
    pub(super) fn block_count(&self) -> usize {
        16 * self.values.len()
    }

    /// Numbers the degrees of freedom of an island, and lays out its rows. `false`, and no room is made, where to
    /// factorize them would take more than [`MOST_WORK`].
    pub(super) fn lay_out(&mut self, m: &Model, jac: &Jacobian, islands: &Islands, island: usize) -> bool {
        if self.made_for == (islands.found, island) {
            return self.fits;
        }
        self.made_for = (islands.found, island);
        #[cfg(test)]
        {
            self.laid_out += 1;
        }
        let trees = || islands.trees_of(island);
        self.len = trees().map(|t| m.tree_dofs(t).len()).sum();
        self.local.resize(m.nv, 0);
        if self.len <= SMALL {
            self.number(m, trees());
        } else {
            let mut order = std::mem::take(&mut self.order);
            order.sort(m, jac, islands, island);
            self.number(m, order.list.iter().rev().map(|&t| t as usize));
            self.order = order;
        }
        self.find_first(m, jac, islands, island);
        self.blocks.clear();
        let (mut start, mut work) = (0, 0);
        for i in 0..self.len.div_ceil(4) {
            let rows = self.first.iter().skip(4 * i).take(4);
            let first = rows.map(|&c| c as usize / 4).min();
            let first = first.unwrap_or_else(|| broken_invariant("four rows have a first column"));
            self.blocks.push(BlockRow { first, start });
            let length = i + 1 - first;
            start += length;
            work += 4 * (4 * length) * (4 * length);
        }
        self.fits = work <= MOST_WORK;
        self.work = (work / 2 + 50 * self.len) as u64;
        if self.fits {
            self.values.resize(start, [[0.0; 4]; 4]);
            self.inverse.resize(self.blocks.len(), [0.0; 4]);
            self.place_mass(m, islands.dofs(island));
            if !math::SMALL {
                self.place_columns(jac, islands.blocks.members(island));
            }
        }
        self.fits
    }

    /// Numbers the degrees of freedom from the last to the first.
    fn number(&mut self, m: &Model, trees: impl Iterator<Item = usize>) {
        let mut left = self.len as u32;
        for k in trees.flat_map(|t| m.tree_dofs(t)) {
            left -= 1;
            self.local[k] = left;
        }
    }

    /// The first column of every row: those of M begin with the first descendant, those of a block of the Jacobian together.
    fn find_first(&mut self, m: &Model, jac: &Jacobian, islands: &Islands, island: usize) {
        let (first, local) = (&mut self.first, &self.local);
        first.clear();
        first.extend(0..self.len as u32);
        let mut lower = |k: usize, column: u32| {
            let first = &mut first[local[k] as usize];
            *first = column.min(*first);
            *first
        };
        for k in islands.dofs(island).flat_map(|dofs| dofs.rev()) {
            let column = lower(k, local[k]);
            if let Ok(parent) = usize::try_from(m.dof_parentid[k]) {
                lower(parent, column);
            }
        }
        for i in islands.blocks.members(island) {
            let columns = jac.columns(&jac.blocks[i]);
            let lowest = columns.iter().map(|&k| local[k as usize]).min().unwrap_or(0);
            for &k in columns {
                lower(k as usize, lowest);
            }
        }
    }

    /// Finds where the numbers of M go.
    fn place_mass(&mut self, m: &Model, runs: impl Iterator<Item = Range<usize>>) {
        self.mass.clear();
        for k in runs.flatten() {
            // It comes before its ancestors here.
            let (blocks, local, column) = (&self.blocks, &self.local, self.local[k] as usize);
            let place = |&j: &i32| place(blocks, local[j as usize] as usize, column) as u32;
            self.mass.extend(m.M_colind[mass::row(m, k)].iter().map(place));
        }
    }

    /// Finds where the columns of blocks of the Jacobian go, by the fours of columns of H that they are among.
    fn place_columns(&mut self, jac: &Jacobian, blocks: impl Iterator<Item = usize>) {
        self.column_blocks.clear();
        self.listed_columns.clear();
        self.lanes.clear();
        for columns in blocks.map(|i| jac.columns(&jac.blocks[i])) {
            if self
                .column_blocks
                .last()
                .is_some_and(|last| self.listed_columns[last.columns.clone()] == *columns)
            {
                continue;
            }
            let (column, first) = (self.listed_columns.len(), self.lanes.len());
            self.listed_columns.extend_from_slice(columns);
            // Ascending in the file, so that those of a tree descend here.
            for (p, &k) in columns.iter().enumerate().rev() {
                let local = self.local[k as usize];
                let (block, lane) = (local / 4, local as usize % 4);
                let mut q = self.lanes.len();
                while q > first && self.lanes[q - 1].block > block {
                    q -= 1;
                }
                if q == first || self.lanes[q - 1].block < block {
                    self.lanes.insert(q, ColumnBlock { block, of: [NONE; 4] });
                    q += 1;
                }
                self.lanes[q - 1].of[lane] = p as u32;
            }
            self.column_blocks.push(ColumnBlocks {
                columns: column..self.listed_columns.len(),
                lanes: first..self.lanes.len(),
            });
        }
    }

    /// Where the columns of a block of the Jacobian are; blocks come in their order.
    #[cfg_attr(not(feature = "small"), inline(always))]
    fn find_lanes(&mut self, columns: &[u32]) -> Range<usize> {
        let left = &self.column_blocks[self.passed..];
        let Some(k) = left.iter().position(|s| self.listed_columns[s.columns.clone()] == *columns) else {
            return 0..0;
        };
        self.passed += k;
        left[k].lanes.clone()
    }

    /// All numbers zero, but for the identity of the rows that fill up.
    pub(super) fn clear(&mut self) {
        self.passed = 0;
        for (i, &BlockRow { first, start }) in self.blocks.iter().enumerate() {
            self.values[start..start + i + 1 - first].fill([[0.0; 4]; 4]);
        }
        for i in self.len..self.capacity() {
            self.values.as_flattened_mut().as_flattened_mut()[place(&self.blocks, i, i)] = 1.0;
        }
    }

    /// Adds M, of which the degrees of freedom of the island are given.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(super) fn add_mass(&mut self, m: &Model, mass: &[f64], runs: impl Iterator<Item = Range<usize>>) {
        let (mut places, values) = (self.mass.as_slice(), self.values.as_flattened_mut().as_flattened_mut());
        for run in runs {
            let rows = &mass[mass::rows_of(m, run)];
            for (number, &place) in rows.iter().zip(places) {
                values[place as usize] += number;
            }
            let left = places.get(rows.len()..);
            places = left.unwrap_or_else(|| broken_invariant("every number of M has a place"));
        }
    }

    /// H = L Lᵀ, in place: each block of L takes that of H, transposed, so that its lanes are the rows of the block.
    #[inline(never)]
    pub(super) fn factor(&mut self) {
        for (i, &BlockRow { first, start }) in self.blocks.iter().enumerate() {
            let (above, below) = self.values.split_at_mut(start);
            let target = &mut below[..i + 1 - first];
            for j in first..=i {
                let mut block = transposed(target[j - first]);
                // Less the products of what is to the left of it in both rows.
                let up = self.blocks[j].first;
                let row = if j < i { &above[self.blocks[j].start..][..j + 1 - up] } else { &*target };
                let from = first.max(up);
                for (left, right) in target[from - first..j - first].iter().zip(&row[from - up..j - up]) {
                    for (left, right) in left.iter().zip(right) {
                        let x = f64x4::new(*left);
                        for (b, y) in block.iter_mut().zip(right) {
                            *b -= x * *y;
                        }
                    }
                }
                if j < i {
                    let corner = row[j - up];
                    for b in 0..4 {
                        block[b] *= self.inverse[j][b];
                        let left = block[b];
                        for c in b + 1..4 {
                            block[c] -= left * corner[b][c];
                        }
                    }
                } else {
                    for b in 0..4 {
                        let diagonal = block[b].to_array()[b].max(MINVAL).sqrt();
                        self.inverse[i][b] = 1.0 / diagonal;
                        block[b] *= self.inverse[i][b];
                        let (left, column) = (block[b], block[b].to_array());
                        for c in b + 1..4 {
                            block[c] -= left * column[c];
                        }
                    }
                }
                target[j - first] = block.map(|b| b.to_array());
            }
        }
    }

    /// x ← H⁻¹ x, factorized.
    #[inline(never)]
    pub(super) fn solve(&self, x: &mut [f64]) {
        let x = x.as_chunks_mut::<4>().0;
        for (i, row) in self.rows() {
            let (before, here) = x.split_at_mut(i);
            let Some((corner, left)) = row.split_last() else {
                return broken_invariant("a row of blocks has its diagonal");
            };
            let mut sum = f64x4::new(here[0]);
            for (block, x) in left.iter().zip(&before[i - left.len()..]) {
                for (column, x) in block.iter().zip(x) {
                    sum -= f64x4::new(*column) * *x;
                }
            }
            let mut solved = sum.to_array();
            for b in 0..4 {
                solved[b] *= self.inverse[i][b];
                for c in b + 1..4 {
                    solved[c] -= corner[b][c] * solved[b];
                }
            }
            here[0] = solved;
        }
        for (i, row) in self.rows().rev() {
            let (before, here) = x.split_at_mut(i);
            let Some((corner, left)) = row.split_last() else {
                return broken_invariant("a row of blocks has its diagonal");
            };
            let mut sum = here[0];
            for b in (0..4).rev() {
                for c in b + 1..4 {
                    sum[b] -= corner[b][c] * sum[c];
                }
                sum[b] *= self.inverse[i][b];
            }
            here[0] = sum;
            let solved = f64x4::new(sum);
            for (block, x) in left.iter().zip(&mut before[i - left.len()..]) {
                for (column, x) in block.iter().zip(x) {
                    *x -= total(f64x4::new(*column) * solved);
                }
            }
        }
    }

    /// The rows of blocks of L, each by its four columns, from the first block to the diagonal.
    fn rows(&self) -> impl DoubleEndedIterator<Item = (usize, &[Tile])> {
        self.blocks.iter().enumerate().map(|(i, b)| (i, &self.values[b.start..][..i + 1 - b.first]))
    }
}

/// Where the number in a row and a column lies.
fn place(blocks: &[BlockRow], row: usize, column: usize) -> usize {
    let BlockRow { first, start } = blocks[row / 4];
    16 * (start + column / 4 - first) + row % 4 * 4 + column % 4
}

impl HessianAccumulator for Hessian {
    fn place(&self, dof: u32) -> usize {
        self.local[dof as usize] as usize
    }

    fn entry(&mut self, row: usize, column: usize) -> Option<&mut f64> {
        let BlockRow { first, start } = *self.blocks.get(row / 4)?;
        let blocks = self.values.get_mut(start..start + row / 4 + 1 - first)?;
        Some(&mut blocks.get_mut((column / 4).wrapping_sub(first))?[row % 4][column % 4])
    }

    #[cfg_attr(not(feature = "small"), inline(always))]
    fn add_weighted_gram<const R: usize>(
        &mut self,
        columns: &[u32],
        v: &[[f64; R]],
        apply_weights: &dyn Fn(&[f64; R]) -> [f64; R],
    ) {
        let index = self.find_lanes(columns);
        let Hessian { lanes, blocks, values, fours, .. } = self;
        let lanes = &lanes[index];
        if fours.len() < R * lanes.len() {
            fours.resize(R * lanes.len(), [0.0; 4]);
        }
        let fours = &mut fours.as_chunks_mut::<R>().0[..lanes.len()];
        for (lane_columns, four) in lanes.iter().zip(fours.iter_mut()) {
            let columns = lane_columns.of.map(|p| v.get(p as usize).unwrap_or(&[0.0; R]));
            *four = from_fn(|r| columns.map(|v| v[r]));
        }
        for (q, lane_columns) in lanes.iter().enumerate() {
            let BlockRow { first, start } = blocks[lane_columns.block as usize];
            let row = &mut values[start..][..lane_columns.block as usize + 1 - first];
            // Beyond the diagonal a row counts as zero, whatever is there.
            let (lanes, fours) = (&lanes[..=q], &fours[..=q]);
            for (lane, p) in lane_columns.of.into_iter().enumerate() {
                let Some(v) = v.get(p as usize) else { continue };
                let w = apply_weights(v).map(f64x4::splat);
                for (to, four) in lanes.iter().zip(fours) {
                    let mut sums = f64x4::new(four[0]) * w[0];
                    for r in 1..R {
                        sums += f64x4::new(four[r]) * w[r];
                    }
                    let to = &mut row[to.block as usize - first][lane];
                    *to = (f64x4::new(*to) + sums).to_array();
                }
            }
        }
    }
}

#[cfg_attr(not(feature = "small"), inline(always))]
fn transposed(rows: Tile) -> [f64x4; 4] {
    from_fn(|c| f64x4::new(rows.map(|row| row[c])))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a test that fails says why
mod tests;
