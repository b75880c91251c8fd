//! Packed lower triangles of at most three rows: the rows of M for a few degrees of freedom in series.
//!
//! They are factorized and solved with sizes known at compile time.

use crate::math::MINVAL;
use crate::model::Model;
use std::ops::Range;

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

/// Calls a function with the number of rows as a constant. The number may be zero.
macro_rules! by_length {
    ($n:expr, $function:ident($($argument:expr),*)) => {
        match $n {
            0 => $function::<0>($($argument),*),
            1 => $function::<1>($($argument),*),
            2 => $function::<2>($($argument),*),
            _ => $function::<3>($($argument),*),
        }
    };
}

/// The size of the serial tree whose last degree of freedom is `end` - 1, if it has at most three.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn size_before(m: &Model, end: usize) -> Option<usize> {
    let n = m.M_rownnz[end - 1] as usize;
    // Columns are ascending: they are consecutive if the first one is where a consecutive range would begin.
    (n <= 3 && m.M_colind[m.M_rowadr[end - 1] as usize] as usize == end - n).then_some(n)
}

/// The number of leading rows of a tree that form a packed triangle, at most three.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn size_from(m: &Model, dofs: &Range<usize>) -> usize {
    let lengths = m.M_rownnz[dofs.clone()].iter().zip(1..=3);
    lengths.take_while(|&(&length, n)| length == n).count()
}

/// Factorizes a packed triangle of `n` rows in place.
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
    start: usize,
) {
    if let (Some(ld), Some(diag_inv), Some(x)) =
        (ld.first_chunk(), diag_inv.first_chunk(), part_mut(x, start))
    {
        solve::<N, T>(ld, diag_inv, x);
    }
}

/// x ← x - xi row for at most three numbers.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn subtract_row(x: &mut [f64], row: &[f64], xi: f64) {
    by_length!(row.len(), subtract_part(x, row, xi));
}

#[cfg_attr(not(feature = "small"), inline(always))]
fn subtract_part<const N: usize>(x: &mut [f64], row: &[f64], xi: f64) {
    if let (Some(x), Some(row)) = (x.first_chunk_mut::<N>(), row.first_chunk::<N>()) {
        (0..N).for_each(|k| x[k] -= row[k] * xi);
    }
}

/// s - row · x for at most three numbers.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn less_row(s: f64, row: &[f64], x: &[f64]) -> f64 {
    by_length!(row.len(), less_part(s, row, x))
}

#[cfg_attr(not(feature = "small"), inline(always))]
fn less_part<const N: usize>(s: f64, row: &[f64], x: &[f64]) -> f64 {
    match (row.first_chunk::<N>(), x.first_chunk::<N>()) {
        (Some(row), Some(x)) => (0..N).fold(s, |s, k| s - row[k] * x[k]),
        _ => s,
    }
}

/// The N numbers starting at index `start`.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn part<const N: usize>(numbers: &[f64], start: usize) -> Option<&[f64; N]> {
    numbers.get(start..)?.first_chunk()
}

#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn part_mut<const N: usize>(numbers: &mut [f64], start: usize) -> Option<&mut [f64; N]> {
    numbers.get_mut(start..)?.first_chunk_mut()
}

/// Factorizes a packed triangle of N rows and T numbers in place.
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
