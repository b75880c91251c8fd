//! The Jacobian of the constraints, in blocks: the rows of one contact or limit, which share their columns.
//!
//! Values are stored column by column within a block, so that products run along the rows: four rows of a
//! frictional contact fill vector registers.

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
    pub(super) fn rows(&self) -> std::ops::Range<usize> {
        self.row as usize..(self.row + self.nrow) as usize
    }
}

/// All blocks, in row order.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Jacobian {
    pub(super) blocks: Vec<Block>,
    values: Vec<f64>,
    columns: Vec<u32>,
}

impl Jacobian {
    pub(super) fn clear(&mut self) {
        self.blocks.clear();
        self.values.clear();
        self.columns.clear();
    }

    /// Appends a block of R rows: one value per row for each column.
    #[inline(always)]
    pub(super) fn push<const R: usize>(&mut self, row: usize, columns: &[u32], mut value: impl FnMut(usize) -> [f64; R]) {
        self.blocks.push(Block {
            row: row as u32,
            nrow: R as u32,
            adr: self.values.len() as u32,
            col: self.columns.len() as u32,
            ncol: columns.len() as u32,
        });
        self.columns.extend_from_slice(columns);
        self.values.reserve(R * columns.len());
        for c in 0..columns.len() {
            self.values.extend_from_slice(&value(c));
        }
    }

    /// The degrees of freedom of a block, ascending.
    #[inline(always)]
    pub(super) fn columns(&self, b: &Block) -> &[u32] {
        &self.columns[b.col as usize..(b.col + b.ncol) as usize]
    }

    #[inline(always)]
    fn values(&self, b: &Block) -> &[f64] {
        &self.values[b.adr as usize..(b.adr + b.nrow * b.ncol) as usize]
    }

    /// out ← J x for the rows of a block.
    #[inline(always)]
    pub(super) fn mul(&self, b: &Block, x: &[f64], out: &mut [f64]) {
        match b.nrow {
            1 => self.mul_rows::<1>(b, x, out),
            _ => self.mul_rows::<4>(b, x, out),
        }
    }

    #[inline(always)]
    fn mul_rows<const R: usize>(&self, b: &Block, x: &[f64], out: &mut [f64]) {
        let mut sum = [0.0; R];
        for (&c, v) in self.columns(b).iter().zip(self.values(b).as_chunks::<R>().0) {
            let x = x[c as usize];
            for r in 0..R {
                sum[r] += v[r] * x;
            }
        }
        out[b.rows()].copy_from_slice(&sum);
    }

    /// out ← out + Jᵀ f for the rows of a block.
    #[inline(always)]
    pub(super) fn add_transposed(&self, b: &Block, f: &[f64], out: &mut [f64]) {
        match b.nrow {
            1 => self.add_transposed_rows::<1>(b, f, out),
            _ => self.add_transposed_rows::<4>(b, f, out),
        }
    }

    #[inline(always)]
    fn add_transposed_rows<const R: usize>(&self, b: &Block, f: &[f64], out: &mut [f64]) {
        let Some(f) = f[b.rows()].first_chunk::<R>() else { return };
        for (&c, v) in self.columns(b).iter().zip(self.values(b).as_chunks::<R>().0) {
            let mut sum = v[0] * f[0];
            for r in 1..R {
                sum += v[r] * f[r];
            }
            out[c as usize] += sum;
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
