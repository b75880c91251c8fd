//! Trees of at most three degrees of freedom, one after the other from the root: most labs are made of them.
//!
//! Their rows of M are a packed lower triangle, which is factorized and solved with all sizes known.

use crate::math::MINVAL;
use crate::model::{Fields, Model};
use std::ops::Range;

/// A tree: its first degree of freedom, how many it has, and where their rows of M begin.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Tree {
    first: usize,
    size: usize,
    row: usize,
}

/// Whether a degree of freedom belongs to one.
pub(crate) fn covers(m: &Model, dof: usize) -> bool {
    let tree = m.tree_dofs(m.dof_treeid[dof] as usize);
    Tree::new(m, tree).is_some()
}

/// Calls a function with the number of rows and of entries of a triangle as constants.
macro_rules! by_size {
    ($n:expr, $function:ident($($argument:expr),*)) => {
        match $n {
            1 => $function::<1, 1>($($argument),*),
            2 => $function::<2, 3>($($argument),*),
            _ => $function::<3, 6>($($argument),*),
        }
    };
}

impl Tree {
    /// The tree with the degrees of freedom `dofs`, if it is such a one.
    pub(crate) fn new(m: &Model, dofs: Range<usize>) -> Option<Tree> {
        if dofs.is_empty() || size_before(m, dofs.end) != Some(dofs.len()) {
            return None;
        }
        let size = dofs.len();
        Some(Tree { first: dofs.start, size, row: m.M_rowadr[dofs.start] as usize })
    }

    /// The tree's part of `qLD` and `qLDiagInv`; and with `x`, x ← M⁻¹ x. Returns the first degree of freedom whose D is
    /// not positive.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(crate) fn factor(
        self,
        mass: &[f64],
        ld: &mut [f64],
        diag_inv: &mut [f64],
        x: Option<&mut [f64]>,
    ) -> Option<usize> {
        by_size!(self.size, factor_copy(self, mass, ld, diag_inv, x))
    }

    /// x ← M⁻¹ x by what [`Tree::factor`] has left.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(crate) fn solve(self, d: &Fields, x: &mut [f64]) {
        let (Some(ld), Some(diag_inv)) = (d.qLD.get(self.row..), d.qLDiagInv.get(self.first..)) else {
            return;
        };
        by_size!(self.size, solve_at(ld, diag_inv, x, self.first));
    }

    /// x ← (M + B)⁻¹ x for a diagonal matrix B (nv).
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(crate) fn solve_with(self, mass: &[f64], b: &[f64], x: &mut [f64]) {
        by_size!(self.size, solve_direct(self, mass, b, x));
    }
}

/// Size of the serial tree whose last degree of freedom is the one before `end`, when it is small.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn size_before(m: &Model, end: usize) -> Option<usize> {
    let n = m.M_rownnz[end - 1] as usize;
    // Columns ascend: they are consecutive when the first is where consecutive ones would begin.
    (n <= 3 && m.M_colind[m.M_rowadr[end - 1] as usize] as usize == end - n).then_some(n)
}

/// The factorization of a packed triangle of `n` rows, in place.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn factor_rows(n: usize, ld: &mut [f64], diag_inv: &mut [f64]) -> Option<usize> {
    by_size!(n, factor_part(ld, diag_inv))
}

#[cfg_attr(not(feature = "small"), inline(always))]
fn factor_part<const N: usize, const T: usize>(ld: &mut [f64], diag_inv: &mut [f64]) -> Option<usize> {
    factor::<N, T>(ld.first_chunk_mut()?, diag_inv.first_chunk_mut()?)
}

/// x ← M⁻¹ x for a packed triangle of `n` rows.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn solve_rows(n: usize, ld: &[f64], diag_inv: &[f64], x: &mut [f64]) {
    by_size!(n, solve_at(ld, diag_inv, x, 0));
}

#[cfg_attr(not(feature = "small"), inline(always))]
fn solve_at<const N: usize, const T: usize>(ld: &[f64], diag_inv: &[f64], x: &mut [f64], at: usize) {
    if let (Some(ld), Some(diag_inv), Some(x)) = (ld.first_chunk(), diag_inv.first_chunk(), part_mut(x, at)) {
        solve::<N, T>(ld, diag_inv, x);
    }
}

#[cfg_attr(not(feature = "small"), inline(always))]
fn factor_copy<const N: usize, const T: usize>(
    tree: Tree,
    mass: &[f64],
    ld: &mut [f64],
    diag_inv: &mut [f64],
    x: Option<&mut [f64]>,
) -> Option<usize> {
    let Tree { first, row, .. } = tree;
    let (ld, diag_inv) = (part_mut(ld, row)?, part_mut(diag_inv, first)?);
    *ld = *part(mass, row)?;
    let bad = factor::<N, T>(ld, diag_inv);
    if let Some(x) = x {
        solve::<N, T>(ld, diag_inv, part_mut(x, first)?);
    }
    bad.map(|k| first + k)
}

#[cfg_attr(not(feature = "small"), inline(always))]
fn solve_direct<const N: usize, const T: usize>(tree: Tree, mass: &[f64], b: &[f64], x: &mut [f64]) {
    let Tree { first, row, .. } = tree;
    let (Some(&ld), Some(b), Some(x)) = (part(mass, row), part::<N>(b, first), part_mut(x, first)) else {
        return;
    };
    let (mut ld, mut diag_inv) = (ld, [0.0; N]);
    for k in 0..N {
        ld[k * (k + 1) / 2 + k] += b[k];
    }
    factor::<N, T>(&mut ld, &mut diag_inv);
    solve::<N, T>(&ld, &diag_inv, x);
}

/// N numbers from a place on.
#[cfg_attr(not(feature = "small"), inline(always))]
fn part<const N: usize>(of: &[f64], at: usize) -> Option<&[f64; N]> {
    of.get(at..)?.first_chunk()
}

#[cfg_attr(not(feature = "small"), inline(always))]
fn part_mut<const N: usize>(of: &mut [f64], at: usize) -> Option<&mut [f64; N]> {
    of.get_mut(at..)?.first_chunk_mut()
}

/// The factorization of a packed triangle of N rows, T numbers.
#[cfg_attr(not(feature = "small"), inline(always))]
fn factor<const N: usize, const T: usize>(ld: &mut [f64; T], diag_inv: &mut [f64; N]) -> Option<usize> {
    let mut bad = None;
    for k in (0..N).rev() {
        let row = k * (k + 1) / 2;
        if ld[row + k] < MINVAL {
            ld[row + k] = MINVAL;
            bad = Some(k);
        }
        let inv = 1.0 / ld[row + k];
        diag_inv[k] = inv;
        for i in (0..k).rev() {
            let factor = ld[row + i] * inv;
            for c in 0..=i {
                ld[i * (i + 1) / 2 + c] -= factor * ld[row + c];
            }
        }
        for c in 0..k {
            ld[row + c] *= inv;
        }
    }
    bad
}

/// x ← M⁻¹ x for a packed triangle.
#[cfg_attr(not(feature = "small"), inline(always))]
fn solve<const N: usize, const T: usize>(ld: &[f64; T], diag_inv: &[f64; N], x: &mut [f64; N]) {
    for i in (0..N).rev() {
        for j in 0..i {
            x[j] -= ld[i * (i + 1) / 2 + j] * x[i];
        }
    }
    for i in 0..N {
        x[i] *= diag_inv[i];
        for j in 0..i {
            x[i] -= ld[i * (i + 1) / 2 + j] * x[j];
        }
    }
}
