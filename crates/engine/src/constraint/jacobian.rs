//! The Jacobian of the constraints, in blocks. A block contains the rows of one contact or limit, which have the same
//! columns.
//!
//! Values are stored column by column within a block, so that products run along the rows: the four rows of a
//! frictional contact fill SIMD registers.

use super::cost::Cost;
use super::row_counts::{MOST_ROWS, by_rows};
use crate::math::{FREE_DOFS, SMALL, dot, dot_in_order};
use crate::model::index::object_index;
use crate::model::{Fields, Model};
use std::ops::Range;
use wide::f64x4;

/// A matrix over the degrees of freedom of an island, which accumulates second derivatives of costs.
pub(super) trait HessianAccumulator {
    /// The row of a degree of freedom, and the element of the lower triangle in a row and a column.
    fn place(&self, dof: u32) -> usize;
    fn entry(&mut self, row: usize, column: usize) -> Option<&mut f64>;
    /// H ← H + Jᵀ W J for the R rows of a block with the given ascending columns. `apply_weights` computes W v.
    fn add_weighted_gram<const R: usize>(
        &mut self,
        columns: &[u32],
        v: &[[f64; R]],
        apply_weights: &dyn Fn(&[f64; R]) -> [f64; R],
    ) where
        Self: Sized;
}

/// Like [`HessianAccumulator::add_weighted_gram`], element by element, for any number of rows. `apply_weights`
/// computes W v.
pub(super) fn add_entries(
    h: &mut dyn HessianAccumulator,
    columns: &[u32],
    v: &[f64],
    apply_weights: &dyn Fn(&[f64], &mut [f64]),
) {
    let n = (v.len() / columns.len().max(1)).max(1);
    let mut weighted = [0.0; MOST_ROWS];
    let weighted = &mut weighted[..n];
    for (&ci, vi) in columns.iter().zip(v.chunks_exact(n)) {
        apply_weights(vi, weighted);
        let row = h.place(ci);
        for (&cj, vj) in columns.iter().zip(v.chunks_exact(n)) {
            let column = h.place(cj);
            if column <= row
                && let Some(entry) = h.entry(row, column)
            {
                *entry += dot_in_order(weighted, vj);
            }
        }
    }
}

/// The rows of one constraint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct JacobianBlock {
    /// First row.
    pub(super) row: u32,
    /// Number of rows.
    pub(super) nrow: u32,
    /// Cost of the deviation from the reference acceleration.
    pub(super) cost: Cost,
    /// First value.
    adr: u32,
    /// First column index, and their number.
    col: u32,
    ncol: u32,
    /// Set if its degrees of freedom are exactly those of one or two free bodies.
    free: FreeBodies,
}

/// Degrees of freedom of two free bodies.
const TWO_FREE: usize = 2 * FREE_DOFS;

/// The number of free bodies, and the first degree of freedom of each.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct FreeBodies {
    bodies: u32,
    first: [u32; 2],
}

impl FreeBodies {
    /// The free bodies with the given degrees of freedom, which are in descending order.
    #[cfg_attr(not(feature = "small"), inline(always))]
    fn from_columns(descending: &[u32]) -> FreeBodies {
        let six = |last: u32, first: u32| last - first + 1 == FREE_DOFS as u32;
        match *descending {
            _ if SMALL => FreeBodies::default(),
            [a, _, _, _, _, b] if six(a, b) => FreeBodies { bodies: 1, first: [b, b] },
            [a, _, _, _, _, b, c, _, _, _, _, d] if six(a, b) && six(c, d) => {
                FreeBodies { bodies: 2, first: [d, b] }
            }
            _ => FreeBodies::default(),
        }
    }
}

impl JacobianBlock {
    /// Its rows, as indexes of the `efc_*` arrays.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(super) fn rows(&self) -> Range<usize> {
        self.row as usize..(self.row + self.nrow) as usize
    }
}

/// The range of the columns if they are consecutive, as for a single body.
#[cfg_attr(not(feature = "small"), inline(always))]
fn contiguous(columns: &[u32]) -> Option<Range<usize>> {
    let (&first, &last) = (columns.first()?, columns.last()?);
    let range = first as usize..last as usize + 1;
    (range.len() == columns.len()).then_some(range)
}

/// Writes items in reverse order.
#[cfg_attr(not(feature = "small"), inline(always))]
fn reversed<T>(items: impl Iterator<Item = T>, to: &mut [T]) {
    for (to, item) in to.iter_mut().rev().zip(items) {
        *to = item;
    }
}

/// v f for four columns.
#[cfg_attr(not(feature = "small"), inline(always))]
fn four_products<const R: usize>(v: &[[f64; R]; 4], f: &[f64; R]) -> f64x4 {
    let mut sum = f64x4::new(v.map(|v| v[0])) * f[0];
    for r in 1..R {
        sum += f64x4::new(v.map(|v| v[r])) * f[r];
    }
    sum
}

/// All blocks, in row order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ConstraintJacobian {
    pub(super) blocks: Vec<JacobianBlock>,
    /// Buffers that only grow and are overwritten in each step; `used_values` and `used_columns` are the lengths in
    /// use.
    values: Vec<f64>,
    columns: Vec<u32>,
    used_values: usize,
    used_columns: usize,
}

impl ConstraintJacobian {
    /// Numbers of blocks, columns and values.
    pub(super) fn size(&self) -> [u64; 3] {
        [self.blocks.len(), self.used_columns, self.used_values].map(|n| n as u64)
    }

    pub(super) fn clear(&mut self) {
        self.blocks.clear();
        (self.used_values, self.used_columns) = (0, 0);
    }

    /// Appends a block of R rows: its columns in descending order, and one value per row for each.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(super) fn push<const R: usize>(
        &mut self,
        cost: Cost,
        row: usize,
        descending: &[u32],
        values: impl Iterator<Item = [f64; R]>,
    ) {
        let rows = self.open_rows(cost, row, R, descending).as_chunks_mut::<R>().0;
        match rows.len() {
            FREE_DOFS if !SMALL => reversed(values, &mut rows[..FREE_DOFS]),
            TWO_FREE if R == 4 && !SMALL => reversed(values, &mut rows[..TWO_FREE]),
            n => reversed(values, &mut rows[..n]),
        }
    }

    /// Appends a block of `nrow` rows with columns in descending order. Returns its values, to be filled.
    #[cfg_attr(not(feature = "small"), inline(always))]
    fn open_rows(&mut self, cost: Cost, row: usize, nrow: usize, descending: &[u32]) -> &mut [f64] {
        let n = descending.len();
        let (adr, col) = (self.used_values, self.used_columns);
        (self.used_values, self.used_columns) = (adr + nrow * n, col + n);
        if self.values.len() < self.used_values {
            self.values.resize(self.used_values, 0.0);
        }
        if self.columns.len() < self.used_columns {
            self.columns.resize(self.used_columns, 0);
        }
        self.blocks.push(JacobianBlock {
            row: row as u32,
            nrow: nrow as u32,
            cost,
            adr: adr as u32,
            col: col as u32,
            ncol: n as u32,
            free: FreeBodies::from_columns(descending),
        });
        let columns = &mut self.columns[col..col + n];
        let items = descending.iter().copied();
        match n {
            FREE_DOFS if !SMALL => reversed(items, &mut columns[..FREE_DOFS]),
            // Specialized code is only worth it for the most common contacts.
            TWO_FREE if nrow == 4 && !SMALL => reversed(items, &mut columns[..TWO_FREE]),
            _ => reversed(items, columns),
        }
        &mut self.values[adr..adr + nrow * n]
    }

    /// The free bodies of a block: the first degree of freedom and the values of each.
    #[cfg_attr(not(feature = "small"), inline(always))]
    fn free_bodies<const R: usize>(
        &self,
        b: &JacobianBlock,
    ) -> impl Iterator<Item = (usize, &[[f64; R]; FREE_DOFS])> {
        let values = self.values[b.adr as usize..].as_chunks::<R>().0.as_chunks::<FREE_DOFS>().0;
        let first = b.free.first.iter().take(b.free.bodies as usize);
        first.map(|&first| first as usize).zip(values)
    }

    /// The degrees of freedom of a block, ascending.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(super) fn columns(&self, b: &JacobianBlock) -> &[u32] {
        &self.columns[b.col as usize..(b.col + b.ncol) as usize]
    }

    /// Whether the columns of the blocks equal the given ones.
    #[inline]
    pub(super) fn same_columns(&self, ends: &[u32], columns: &[u32]) -> bool {
        ends.len() == self.blocks.len()
            && *columns == self.columns[..self.used_columns]
            && self.blocks.iter().zip(ends).all(|(b, &end)| b.col + b.ncol == end)
    }

    pub(super) fn copy_columns(&self, ends: &mut Vec<u32>, columns: &mut Vec<u32>) {
        ends.clear();
        ends.extend(self.blocks.iter().map(|b| b.col + b.ncol));
        columns.clear();
        columns.extend_from_slice(&self.columns[..self.used_columns]);
    }

    /// Appends a block of one row. Its columns are ascending, with one value each.
    pub(super) fn push_sparse(
        &mut self,
        cost: Cost,
        row: usize,
        columns: &[i32],
        values: impl Iterator<Item = f64>,
    ) {
        self.start_block(cost, row);
        for (&c, v) in columns.iter().zip(values) {
            self.append(c, v);
        }
    }

    /// Appends the row a + factor b. The columns of both are ascending.
    pub(super) fn push_sum(
        &mut self,
        cost: Cost,
        row: usize,
        (mut ca, mut va): (&[i32], &[f64]),
        (mut cb, mut vb): (&[i32], &[f64]),
        factor: f64,
    ) {
        self.start_block(cost, row);
        loop {
            match (ca, va, cb, vb) {
                ([a, na @ ..], [x, nx @ ..], [b, nb @ ..], [y, ny @ ..]) if a == b => {
                    self.append(*a, x + factor * y);
                    (ca, va, cb, vb) = (na, nx, nb, ny);
                }
                ([a, na @ ..], [x, nx @ ..], rest, _) if rest.first().is_none_or(|b| a < b) => {
                    self.append(*a, *x);
                    (ca, va) = (na, nx);
                }
                (_, _, [b, nb @ ..], [y, ny @ ..]) => {
                    self.append(*b, factor * y);
                    (cb, vb) = (nb, ny);
                }
                _ => return,
            }
        }
    }

    /// Appends a block with the rows of another block and other, ascending columns. Returns its values, which are
    /// zero.
    pub(super) fn push_zeros(
        &mut self,
        like: &JacobianBlock,
        columns: impl Iterator<Item = usize>,
    ) -> &mut [f64] {
        self.start_block(like.cost, like.row as usize);
        let (adr, col) = (self.used_values, self.used_columns);
        for c in columns {
            if self.columns.len() <= self.used_columns {
                self.columns.resize(self.used_columns + 1, 0);
            }
            self.columns[self.used_columns] = c as u32;
            self.used_columns += 1;
        }
        let ncol = self.used_columns - col;
        self.used_values = adr + ncol * like.nrow as usize;
        if self.values.len() < self.used_values {
            self.values.resize(self.used_values, 0.0);
        }
        if let Some(b) = self.blocks.last_mut() {
            (b.nrow, b.ncol) = (like.nrow, ncol as u32);
        }
        let values = &mut self.values[adr..self.used_values];
        values.fill(0.0);
        values
    }

    /// The kinematic trees that a block moves, ascending.
    pub(super) fn trees<'a>(
        &'a self,
        m: &'a Model,
        b: &JacobianBlock,
    ) -> impl Iterator<Item = usize> + Clone + use<'a> {
        let mut last = usize::MAX;
        let tree = |&c: &u32| object_index(m.dof_treeid[c as usize]);
        self.columns(b).iter().map(tree).filter(move |&t| std::mem::replace(&mut last, t) != t)
    }

    /// Starts a block of one row.
    fn start_block(&mut self, cost: Cost, row: usize) {
        let (adr, col) = (self.used_values as u32, self.used_columns as u32);
        self.blocks.push(JacobianBlock {
            row: row as u32,
            nrow: 1,
            cost,
            adr,
            col,
            ncol: 0,
            free: FreeBodies::default(),
        });
    }

    /// Adds a column to the last block.
    fn append(&mut self, column: i32, value: f64) {
        let (index, col) = (self.used_values, self.used_columns);
        (self.used_values, self.used_columns) = (index + 1, col + 1);
        if self.values.len() <= index {
            self.values.resize(index + 1, 0.0);
        }
        if self.columns.len() <= col {
            self.columns.resize(col + 1, 0);
        }
        (self.values[index], self.columns[col]) = (value, column as u32);
        if let Some(b) = self.blocks.last_mut() {
            b.ncol += 1;
        }
    }

    /// Removes the last block if it moves nothing. Returns whether the block was kept.
    pub(super) fn keep_if_moving(&mut self, m: &Model) -> bool {
        let dense = super::is_dense(m);
        let moves =
            |b: &JacobianBlock| if dense { self.values(b).iter().any(|&v| v != 0.0) } else { b.ncol > 0 };
        let keep = self.blocks.last().is_some_and(moves);
        if !keep {
            self.pop();
        }
        keep
    }

    /// Removes the last block.
    pub(super) fn pop(&mut self) {
        if let Some(b) = self.blocks.pop() {
            (self.used_values, self.used_columns) = (b.adr as usize, b.col as usize);
        }
    }

    /// The values of a block, column by column.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(super) fn values(&self, b: &JacobianBlock) -> &[f64] {
        &self.values[b.adr as usize..(b.adr + b.nrow * b.ncol) as usize]
    }

    /// Whether any row has a column in the range of degrees of freedom.
    pub(crate) fn touches(&self, dofs: Range<usize>) -> bool {
        self.columns[..self.used_columns].iter().any(|&k| dofs.contains(&(k as usize)))
    }

    /// out ← J x for all rows.
    #[inline]
    pub(super) fn mul(&self, x: &[f64], out: &mut [f64]) {
        for b in &self.blocks {
            self.mul_block(b, x, out);
        }
    }

    /// out ← J x - aref for all rows.
    #[inline]
    pub(super) fn residual(&self, x: &[f64], aref: &[f64], out: &mut [f64]) {
        self.mul(x, out);
        for (x, aref) in out.iter_mut().zip(aref) {
            *x -= aref;
        }
    }

    /// out ← J x for the rows of a block.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(super) fn mul_block(&self, b: &JacobianBlock, x: &[f64], out: &mut [f64]) {
        if SMALL {
            let sums = &mut out[b.rows()];
            sums.fill(0.0);
            for (&k, v) in self.terms(b) {
                sums.iter_mut().zip(v).for_each(|(sum, v)| *sum += v * x[k as usize]);
            }
        } else {
            by_rows!(b.nrow, R => self.mul_rows::<R>(b, x, out))
        }
    }

    /// The columns of a block, each with its values for all rows.
    #[inline]
    pub(super) fn terms(&self, b: &JacobianBlock) -> impl Iterator<Item = (&u32, &[f64])> {
        self.columns(b).iter().zip(self.values(b).chunks_exact(b.nrow as usize))
    }

    #[cfg_attr(not(feature = "small"), inline(always))]
    fn mul_rows<const R: usize>(&self, b: &JacobianBlock, x: &[f64], out: &mut [f64]) {
        let mut sum = [0.0; R];
        let mut accumulate = |v: &[f64; R], x: f64| {
            for r in 0..R {
                sum[r] += v[r] * x;
            }
        };
        if b.free.bodies > 0 {
            for (first, v) in self.free_bodies::<R>(b) {
                if let Some(x) = x[first..].first_chunk::<FREE_DOFS>() {
                    for c in 0..FREE_DOFS {
                        accumulate(&v[c], x[c]);
                    }
                }
            }
        } else {
            let (cols, vals) = (self.columns(b), self.values(b).as_chunks::<R>().0);
            match contiguous(cols) {
                Some(range) => vals.iter().zip(&x[range]).for_each(|(v, &x)| accumulate(v, x)),
                None => vals.iter().zip(cols).for_each(|(v, &c)| accumulate(v, x[c as usize])),
            }
        }
        if let Some(out) = out[b.rows()].first_chunk_mut::<R>() {
            *out = sum;
        }
    }

    /// out ← out + Jᵀ f for the R rows of a block.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(super) fn add_transposed<const R: usize>(&self, b: &JacobianBlock, f: &[f64; R], out: &mut [f64]) {
        if SMALL {
            return self.add_rows_transposed(b, 0, f, out);
        }
        if b.free.bodies > 0 {
            for (first, v) in self.free_bodies::<R>(b) {
                if let Some(out) = out[first..].first_chunk_mut::<FREE_DOFS>() {
                    let (fours, rest) = out.as_chunks_mut::<4>();
                    for (out, v) in fours.iter_mut().zip(v.as_chunks::<4>().0) {
                        *out = (f64x4::new(*out) + four_products(v, f)).to_array();
                    }
                    for (out, v) in rest.iter_mut().zip(&v[4..]) {
                        *out += dot(*v, *f);
                    }
                }
            }
            return;
        }
        let (cols, vals) =
            (self.columns(b).as_chunks::<4>(), self.values(b).as_chunks::<R>().0.as_chunks::<4>());
        for (cols, v) in cols.0.iter().zip(vals.0) {
            for (&c, sum) in cols.iter().zip(four_products(v, f).to_array()) {
                out[c as usize] += sum;
            }
        }
        for (&c, v) in cols.1.iter().zip(vals.1) {
            out[c as usize] += dot(*v, *f);
        }
    }
}

impl ConstraintJacobian {
    /// out ← out + Jᵀ f for the rows of a block that start at its row `first`.
    pub(super) fn add_rows_transposed(&self, b: &JacobianBlock, first: usize, f: &[f64], out: &mut [f64]) {
        for (&k, v) in self.terms(b) {
            out[k as usize] += dot_in_order(&v[first..], f);
        }
    }
}

/// The Jacobian of the constraints as a dense matrix, `nefc` x `nv`, row-major (`efc_J`).
pub fn full_j(m: &Model, d: &Fields, jac: &ConstraintJacobian) -> Vec<f64> {
    let mut out = vec![0.0; d.nefc * m.nv];
    for b in &jac.blocks {
        for (&k, values) in jac.columns(b).iter().zip(jac.values(b).chunks_exact(b.nrow as usize)) {
            for (row, v) in b.rows().zip(values) {
                if let Some(entry) = out.get_mut(row * m.nv + k as usize) {
                    *entry = *v;
                }
            }
        }
    }
    out
}
