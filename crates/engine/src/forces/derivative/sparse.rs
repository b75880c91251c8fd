//! Matrices that couple every degree of freedom with its ancestors and descendants, with both triangles stored: sums,
//! products, factorization.
//!
//! A row contains the ancestors of its degree of freedom, itself, and its descendants, ascending (`D_rowadr`, `D_diag`,
//! `D_colind`). The ancestors of an ancestor are a prefix of a row's ancestors, and descendants are consecutive, so that every
//! entry is found without a search. Elimination from the last row to the first creates no new entries (Featherstone 2008, section
//! 6.5, for the symmetric case).

use crate::math::MINVAL;
use crate::model::Model;

/// The index of the first entry of row `i`, and that of its diagonal.
#[cfg_attr(not(feature = "small"), inline(always))]
fn place(m: &Model, i: usize) -> (usize, usize) {
    let start = m.D_rowadr[i] as usize;
    (start, start + m.D_diag[i] as usize)
}

/// The ancestors of degree of freedom `i`, ascending.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn ancestors(m: &Model, i: usize) -> &[i32] {
    let (start, diag) = place(m, i);
    &m.D_colind[start..diag]
}

/// The index of element (i, j), where j is the a-th ancestor of i, and that of (j, i).
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn pair(m: &Model, i: usize, j: usize, a: usize) -> (usize, usize) {
    (m.D_rowadr[i] as usize + a, place(m, j).1 + (i - j))
}

/// The index of element (i, i).
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn diagonal(m: &Model, i: usize) -> usize {
    place(m, i).1
}

/// out ← M - h out, where `mass` is the lower triangle of M in its own pattern.
pub(crate) fn mass_minus(m: &Model, mass: &[f64], h: f64, out: &mut [f64]) {
    for x in out.iter_mut() {
        *x *= -h;
    }
    for i in 0..m.nv {
        let first = m.M_rowadr[i] as usize;
        let n = m.M_rownnz[i] as usize - 1;
        out[diagonal(m, i)] += mass[first + n];
        // The row of a simple body contains only its diagonal; all others contain all ancestors.
        for a in 0..n {
            let (lower, upper) = pair(m, i, m.M_colind[first + a] as usize, a);
            out[lower] += mass[first + a];
            out[upper] += mass[first + a];
        }
    }
}

/// The indexes of the last `n` entries of row `i` up to its diagonal, where n is the length of its row of M.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn lower(m: &Model, i: usize, n: usize) -> std::ops::Range<usize> {
    let end = diagonal(m, i) + 1;
    end - n..end
}

/// out ← out - h lower(whole), in the pattern of M.
pub(crate) fn subtract_lower(m: &Model, whole: &[f64], h: f64, out: &mut [f64]) {
    for i in 0..m.nv {
        let (first, n) = (m.M_rowadr[i] as usize, m.M_rownnz[i] as usize);
        for (x, y) in out[first..first + n].iter_mut().zip(&whole[lower(m, i, n)]) {
            *x -= h * y;
        }
    }
}

/// Adds s x xᵀ for a sparse vector to the entries of the pattern. `dofs` must be ascending.
pub(crate) fn add_outer(m: &Model, dofs: &[i32], values: &[f64], s: f64, out: &mut [f64]) {
    for (k, (&i, x)) in dofs.iter().zip(values).enumerate() {
        let i = i as usize;
        out[diagonal(m, i)] += s * x * x;
        if k == 0 {
            continue;
        }
        let up = ancestors(m, i);
        let mut a = 0;
        for (&j, y) in dofs[..k].iter().zip(values) {
            while a < up.len() && up[a] < j {
                a += 1;
            }
            if a < up.len() && up[a] == j {
                let (lower, upper) = pair(m, i, j as usize, a);
                out[lower] += s * x * y;
                out[upper] += s * x * y;
            }
        }
    }
}

/// out ← A x.
pub(crate) fn mul(m: &Model, a: &[f64], x: &[f64], out: &mut [f64]) {
    for i in 0..m.nv {
        let row = m.D_rowadr[i] as usize..(m.D_rowadr[i] + m.D_rownnz[i]) as usize;
        out[i] = m.D_colind[row.clone()].iter().zip(&a[row]).map(|(&j, v)| v * x[j as usize]).sum();
    }
}

/// Factorizes in place, A = U L with unit upper U. Returns the first degree of freedom with a vanishing pivot, which
/// is replaced by the smallest valid divisor.
pub(crate) fn factor(m: &Model, lu: &mut [f64]) -> Option<usize> {
    let mut bad = None;
    for k in (0..m.nv).rev() {
        let (start, diag) = place(m, k);
        let (above, rest) = lu.split_at_mut(start);
        let row = &mut rest[..diag - start + 1];
        let n = row.len() - 1;
        if row[n].abs() < MINVAL {
            row[n] = MINVAL;
            bad = Some(k);
        }
        let inv = 1.0 / row[n];
        let up = &m.D_colind[start..diag];
        for (a, &i) in up.iter().enumerate() {
            let i = i as usize;
            let (first, middle) = place(m, i);
            let factor = above[middle + (k - i)] * inv;
            above[middle + (k - i)] = factor;
            for (x, y) in above[first..].iter_mut().zip(&row[..a + 1]) {
                *x -= factor * y;
            }
            for (&j, y) in up[a + 1..].iter().zip(&row[a + 1..n]) {
                above[middle + (j as usize - i)] -= factor * y;
            }
        }
    }
    bad
}

/// x ← A⁻¹ x.
pub(crate) fn solve(m: &Model, lu: &[f64], x: &mut [f64]) {
    for k in (0..m.nv).rev() {
        for &i in ancestors(m, k) {
            let i = i as usize;
            x[i] -= lu[place(m, i).1 + (k - i)] * x[k];
        }
    }
    for k in 0..m.nv {
        let (start, diag) = place(m, k);
        let s: f64 =
            m.D_colind[start..diag].iter().zip(&lu[start..diag]).map(|(&j, l)| l * x[j as usize]).sum();
        x[k] = (x[k] - s) / lu[diag];
    }
}
