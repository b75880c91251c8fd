//! The Hessian of an island, M + Jᵀ C J, and its factorization H = L Lᵀ.
//!
//! The lower triangle is stored in blocks of 4 x 4, which fit SIMD lanes. Each row of blocks is stored from its first
//! nonzero block to the diagonal. L creates no fill-in outside of this profile (George and Liu 1981, *Computer
//! Solution of Large Sparse Positive Definite Systems*, ch. 4). Each tree is numbered from its leaves to its root, so
//! that its branches share no rows before the bodies that carry them. In large islands, most pairs of trees do not
//! interact. Their trees are ordered so that rows are short: breadth first from an end of the island, reversed
//! (Cuthill and McKee 1969, George 1971).

mod tree_order;

use super::island::Islands;
use super::jacobian::{ConstraintJacobian, HessianAccumulator};
use crate::dynamics::mass;
use crate::math::lanes::total;
use crate::math::{self, MINVAL, broken_invariant};
use crate::model::Model;
use std::array::from_fn;
use std::ops::Range;
use tree_order::TreeOrder;
use wide::f64x4;

/// Maximum number of degrees of freedom for which trees keep the order of the model.
const MAX_MODEL_ORDER_DOFS: usize = 120;

/// Maximum of the sum of squared row lengths for which an island is solved with its Hessian: that of a thousand
/// degrees of freedom that all interact. Beyond that a step would take minutes, and conjugate gradients find the same
/// solution without the Hessian.
const MOST_WORK: usize = 330_000_000;

/// Four consecutive numbers of a row, and a block of 4 x 4, row-major.
type Four = [f64; 4];
type Tile = [Four; 4];

/// A symmetric matrix: its lower triangle in rows of blocks. The last row of blocks is padded with rows of the
/// identity.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Hessian {
    /// Position of each degree of freedom of the model in its island.
    pub(super) local: Vec<u32>,
    values: Vec<Tile>,
    /// Inverse diagonal of L.
    inverse: Vec<Four>,
    blocks: Vec<BlockRow>,
    /// Number of rows without padding.
    len: usize,
    /// What the current layout is for: the count of island searches and the island. `fits` is false if the island
    /// exceeds [`MOST_WORK`].
    made_for: (u64, usize),
    fits: bool,
    /// Work units of a factorization.
    pub(super) work: u64,
    /// The first column of each row.
    first: Vec<u32>,
    /// Index in `values` of each number of M, for the rows of the island in order.
    mass: Vec<u32>,
    /// For blocks of the Jacobian: their columns, the column blocks of H that contain them, and the number of blocks
    /// already added.
    column_blocks: Vec<ColumnBlocks>,
    listed_columns: Vec<u32>,
    lanes: Vec<ColumnBlock>,
    passed: usize,
    /// Scratch for a block of the Jacobian: its rows in groups of four columns.
    fours: Vec<Four>,
    order: TreeOrder,
    /// How many times a layout was computed.
    #[cfg(test)]
    pub(super) laid_out: usize,
}

/// A row of blocks: the column of its first block, and its index in `values`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct BlockRow {
    first: usize,
    start: usize,
}

/// The columns of a block of the Jacobian, or of consecutive blocks with the same columns: ranges in `listed_columns`
/// and `lanes`.
#[derive(Clone, Debug, PartialEq)]
struct ColumnBlocks {
    columns: Range<usize>,
    lanes: Range<usize>,
}

/// A column block of H, and for each of its four columns the corresponding column of the Jacobian block, or [`NONE`].
#[derive(Clone, Copy, Debug, PartialEq)]
struct ColumnBlock {
    block: u32,
    columns: [u32; 4],
}

/// Marks a column that the Jacobian block does not have.
const NONE: u32 = u32::MAX;

impl Hessian {
    /// The island of the current layout.
    pub(super) fn island(&self) -> usize {
        self.made_for.1
    }

    /// Number of elements of a vector, including padding.
    pub(super) fn capacity(&self) -> usize {
        4 * self.blocks.len()
    }

    /// Number of stored matrix elements.
    #[cfg(test)]
    pub(super) fn block_count(&self) -> usize {
        16 * self.values.len()
    }

    /// Numbers the degrees of freedom of an island and computes the layout of its rows. Returns `false`, without
    /// allocating memory, if the factorization would take more than [`MOST_WORK`].
    pub(super) fn compute_layout(
        &mut self,
        m: &Model,
        jac: &ConstraintJacobian,
        islands: &Islands,
        island: usize,
    ) -> bool {
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
        if self.len <= MAX_MODEL_ORDER_DOFS {
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

    /// Numbers the degrees of freedom in reverse, starting with the last number.
    fn number(&mut self, m: &Model, trees: impl Iterator<Item = usize>) {
        let mut left = self.len as u32;
        for k in trees.flat_map(|t| m.tree_dofs(t)) {
            left -= 1;
            self.local[k] = left;
        }
    }

    /// Finds the first column of every row. Rows of M begin at the first descendant; rows of a Jacobian block all
    /// begin at its first column.
    fn find_first(&mut self, m: &Model, jac: &ConstraintJacobian, islands: &Islands, island: usize) {
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

    /// Finds the index of each number of M.
    fn place_mass(&mut self, m: &Model, runs: impl Iterator<Item = Range<usize>>) {
        self.mass.clear();
        for k in runs.flatten() {
            // In this numbering a degree of freedom precedes its ancestors.
            let (blocks, local, column) = (&self.blocks, &self.local, self.local[k] as usize);
            let place = |&j: &i32| place(blocks, local[j as usize] as usize, column) as u32;
            self.mass.extend(m.M_colind[mass::row(m, k)].iter().map(place));
        }
    }

    /// Finds the column blocks of H for the columns of Jacobian blocks.
    fn place_columns(&mut self, jac: &ConstraintJacobian, blocks: impl Iterator<Item = usize>) {
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
            // Columns are ascending in the model, so those of a tree are descending in this numbering.
            for (p, &k) in columns.iter().enumerate().rev() {
                let local = self.local[k as usize];
                let (block, lane) = (local / 4, local as usize % 4);
                let mut q = self.lanes.len();
                while q > first && self.lanes[q - 1].block > block {
                    q -= 1;
                }
                if q == first || self.lanes[q - 1].block < block {
                    self.lanes.insert(q, ColumnBlock { block, columns: [NONE; 4] });
                    q += 1;
                }
                self.lanes[q - 1].columns[lane] = p as u32;
            }
            self.column_blocks.push(ColumnBlocks {
                columns: column..self.listed_columns.len(),
                lanes: first..self.lanes.len(),
            });
        }
    }

    /// The range in `lanes` of the columns of a Jacobian block. Blocks must be looked up in order.
    #[cfg_attr(not(feature = "small"), inline(always))]
    fn find_lanes(&mut self, columns: &[u32]) -> Range<usize> {
        let left = &self.column_blocks[self.passed..];
        let Some(k) = left.iter().position(|s| self.listed_columns[s.columns.clone()] == *columns) else {
            return 0..0;
        };
        self.passed += k;
        left[k].lanes.clone()
    }

    /// Sets all elements to zero, except the identity in the padding rows.
    pub(super) fn clear(&mut self) {
        self.passed = 0;
        for (i, &BlockRow { first, start }) in self.blocks.iter().enumerate() {
            self.values[start..start + i + 1 - first].fill([[0.0; 4]; 4]);
        }
        for i in self.len..self.capacity() {
            self.values.as_flattened_mut().as_flattened_mut()[place(&self.blocks, i, i)] = 1.0;
        }
    }

    /// Adds M for the given degrees of freedom of the island.
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

    /// H = L Lᵀ, in place. Each block of L replaces that of H, transposed, so that its lanes are the rows of the
    /// block.
    #[inline(never)]
    pub(super) fn factor(&mut self) {
        for (i, &BlockRow { first, start }) in self.blocks.iter().enumerate() {
            let (above, below) = self.values.split_at_mut(start);
            let target = &mut below[..i + 1 - first];
            for j in first..=i {
                let mut block = transposed(target[j - first]);
                // Subtracts the products of the blocks to the left in both rows.
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

    /// x ← H⁻¹ x, using the factorization.
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

    /// The rows of blocks of L, from the first block to the diagonal, each block by columns.
    fn rows(&self) -> impl DoubleEndedIterator<Item = (usize, &[Tile])> {
        self.blocks.iter().enumerate().map(|(i, b)| (i, &self.values[b.start..][..i + 1 - b.first]))
    }
}

/// The index of an element in the flattened `values`.
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
            let columns = lane_columns.columns.map(|p| v.get(p as usize).unwrap_or(&[0.0; R]));
            *four = from_fn(|r| columns.map(|v| v[r]));
        }
        for (q, lane_columns) in lanes.iter().enumerate() {
            let BlockRow { first, start } = blocks[lane_columns.block as usize];
            let row = &mut values[start..][..lane_columns.block as usize + 1 - first];
            // Elements of diagonal blocks above the diagonal are never read, so they may be overwritten.
            let (lanes, fours) = (&lanes[..=q], &fours[..=q]);
            for (lane, p) in lane_columns.columns.into_iter().enumerate() {
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
#[allow(clippy::unwrap_used)] // a failing test prints the reason
mod tests;
