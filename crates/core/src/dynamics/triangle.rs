//! Packed lower triangles of at most three rows: what M of a few degrees of freedom is that stand one after the other.
//!
//! They are factorized and solved with all sizes known.

use crate::math::MINVAL;
use crate::model::Model;

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
pub(super) use by_size;

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
pub(super) fn solve_at<const N: usize, const T: usize>(
    ld: &[f64],
    diag_inv: &[f64],
    x: &mut [f64],
    at: usize,
) {
    if let (Some(ld), Some(diag_inv), Some(x)) = (ld.first_chunk(), diag_inv.first_chunk(), part_mut(x, at)) {
        solve::<N, T>(ld, diag_inv, x);
    }
}

/// N numbers from a place on.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn part<const N: usize>(of: &[f64], at: usize) -> Option<&[f64; N]> {
    of.get(at..)?.first_chunk()
}

#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn part_mut<const N: usize>(of: &mut [f64], at: usize) -> Option<&mut [f64; N]> {
    of.get_mut(at..)?.first_chunk_mut()
}

/// The factorization of a packed triangle of N rows, T numbers.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn factor<const N: usize, const T: usize>(
    ld: &mut [f64; T],
    diag_inv: &mut [f64; N],
) -> Option<usize> {
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
pub(super) fn solve<const N: usize, const T: usize>(ld: &[f64; T], diag_inv: &[f64; N], x: &mut [f64; N]) {
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
