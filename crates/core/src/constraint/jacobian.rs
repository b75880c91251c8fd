//! The Jacobian of the constraints, in blocks: the rows of one contact or limit, which share their columns.
//!
//! Values are stored column by column within a block, so that products run along the rows: four rows of a
//! frictional contact fill vector registers.

use crate::math::dot;
use std::ops::Range;

/// The rows of one constraint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Block {
    /// First row.
    pub(super) row: u32,
    /// Number of rows.
    pub(super) nrow: u32,
    /// First value.
    adr: u32,
    /// First column index, and their number.
    col: u32,
    ncol: u32,
}

impl Block {
    /// Its rows, as indices of the `efc_*` arrays.
    #[inline(always)]
    pub(super) fn rows(&self) -> Range<usize> {
        self.row as usize..(self.row + self.nrow) as usize
    }
}

/// Degrees of freedom of a free body: against the static world it is the commonest block, worth its own
/// unrolled loops.
const FREE: usize = 6;

/// The range of the columns when there is no gap between them: one body's, as a rule.
#[inline(always)]
fn contiguous(columns: &[u32]) -> Option<Range<usize>> {
    let (&first, &last) = (columns.first()?, columns.last()?);
    let range = first as usize..last as usize + 1;
    (range.len() == columns.len()).then_some(range)
}

/// All blocks, in row order.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Jacobian {
    pub(super) blocks: Vec<Block>,
    /// Room that grows and is written over; the blocks say how much of it is used.
    values: Vec<f64>,
    columns: Vec<u32>,
    used_values: usize,
    used_columns: usize,
}

impl Jacobian {
    pub(super) fn clear(&mut self) {
        self.blocks.clear();
        (self.used_values, self.used_columns) = (0, 0);
    }

    /// Appends a block of R rows: its columns in descending order, and one value per row for each.
    #[inline(always)]
    pub(super) fn push<const R: usize>(
        &mut self,
        row: usize,
        descending: &[u32],
        values: impl Iterator<Item = [f64; R]>,
    ) {
        let n = descending.len();
        let (adr, col) = (self.used_values, self.used_columns);
        (self.used_values, self.used_columns) = (adr + R * n, col + n);
        if self.values.len() < self.used_values {
            self.values.resize(self.used_values, 0.0);
        }
        if self.columns.len() < self.used_columns {
            self.columns.resize(self.used_columns, 0);
        }
        self.blocks.push(Block {
            row: row as u32,
            nrow: R as u32,
            adr: adr as u32,
            col: col as u32,
            ncol: n as u32,
        });
        for (c, &k) in self.columns[col..col + n].iter_mut().rev().zip(descending) {
            *c = k;
        }
        for (v, value) in self.values[adr..adr + R * n].as_chunks_mut::<R>().0.iter_mut().rev().zip(values) {
            *v = value;
        }
    }

    /// The degrees of freedom of a block, ascending.
    #[inline(always)]
    pub(super) fn columns(&self, b: &Block) -> &[u32] {
        &self.columns[b.col as usize..(b.col + b.ncol) as usize]
    }

    /// Whether the blocks have these columns.
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

    #[inline(always)]
    fn values(&self, b: &Block) -> &[f64] {
        &self.values[b.adr as usize..(b.adr + b.nrow * b.ncol) as usize]
    }

    /// Whether some row has a column among these degrees of freedom.
    pub(crate) fn touches(&self, dofs: Range<usize>) -> bool {
        self.columns[..self.used_columns].iter().any(|&k| dofs.contains(&(k as usize)))
    }

    /// out ← J x, all rows.
    #[inline]
    pub(super) fn mul(&self, x: &[f64], out: &mut [f64]) {
        for b in &self.blocks {
            self.mul_block(b, x, out);
        }
    }

    /// out ← J x - aref, all rows.
    #[inline]
    pub(super) fn residual(&self, x: &[f64], aref: &[f64], out: &mut [f64]) {
        self.mul(x, out);
        for (x, aref) in out.iter_mut().zip(aref) {
            *x -= aref;
        }
    }

    /// out ← J x for the rows of a block.
    #[inline(always)]
    pub(super) fn mul_block(&self, b: &Block, x: &[f64], out: &mut [f64]) {
        match b.nrow {
            1 => self.mul_rows::<1>(b, x, out),
            _ => self.mul_rows::<4>(b, x, out),
        }
    }

    #[inline(always)]
    fn mul_rows<const R: usize>(&self, b: &Block, x: &[f64], out: &mut [f64]) {
        let mut sum = [0.0; R];
        let mut accumulate = |v: &[f64; R], x: f64| {
            for r in 0..R {
                sum[r] += v[r] * x;
            }
        };
        let (cols, vals) = (self.columns(b), self.values(b).as_chunks::<R>().0);
        match contiguous(cols) {
            Some(range) => match (vals.first_chunk::<FREE>(), x[range.clone()].first_chunk::<FREE>()) {
                (Some(v), Some(x)) if range.len() == FREE => {
                    for c in 0..FREE {
                        accumulate(&v[c], x[c]);
                    }
                }
                _ => {
                    for (v, &x) in vals.iter().zip(&x[range]) {
                        accumulate(v, x);
                    }
                }
            },
            None => {
                for (v, &c) in vals.iter().zip(cols) {
                    accumulate(v, x[c as usize]);
                }
            }
        }
        if let Some(out) = out[b.rows()].first_chunk_mut::<R>() {
            *out = sum;
        }
    }

    /// out ← out + Jᵀ f for the R rows of a block.
    #[inline(always)]
    pub(super) fn add_transposed<const R: usize>(&self, b: &Block, f: &[f64; R], out: &mut [f64]) {
        let (cols, vals) = (self.columns(b), self.values(b).as_chunks::<R>().0);
        match contiguous(cols) {
            Some(range) => match (vals.first_chunk::<FREE>(), out[range.clone()].first_chunk_mut::<FREE>()) {
                (Some(v), Some(out)) if range.len() == FREE => {
                    for c in 0..FREE {
                        out[c] += dot(v[c], *f);
                    }
                }
                _ => {
                    for (v, out) in vals.iter().zip(&mut out[range]) {
                        *out += dot(*v, *f);
                    }
                }
            },
            None => {
                for (v, &c) in vals.iter().zip(cols) {
                    out[c as usize] += dot(*v, *f);
                }
            }
        }
    }

    /// h ← h + Jᵀ diag(w) J for the rows of a block, lower triangle of a dense n × n matrix whose indices
    /// are `local`.
    #[inline(always)]
    pub(super) fn add_gram(&self, b: &Block, w: &[f64], local: &[u32], h: &mut [f64], n: usize) {
        match b.nrow {
            1 => self.add_gram_rows::<1>(b, w, local, h, n),
            _ => self.add_gram_rows::<4>(b, w, local, h, n),
        }
    }

    #[inline(always)]
    fn add_gram_rows<const R: usize>(&self, b: &Block, w: &[f64], local: &[u32], h: &mut [f64], n: usize) {
        let (cols, vals) = (self.columns(b), self.values(b).as_chunks::<R>().0);
        let Some(w) = w[b.rows()].first_chunk::<R>() else { return };
        for (i, (&ci, vi)) in cols.iter().zip(vals).enumerate() {
            let wi: [f64; R] = std::array::from_fn(|r| w[r] * vi[r]);
            let row = &mut h[local[ci as usize] as usize * n..][..n];
            // Columns ascend, and so do their local indices: these are in the lower triangle.
            for (&cj, vj) in cols[..=i].iter().zip(vals) {
                let mut sum = wi[0] * vj[0];
                for r in 1..R {
                    sum += wi[r] * vj[r];
                }
                row[local[cj as usize] as usize] += sum;
            }
        }
    }
}
