//! Newton's direction of an island of six degrees of freedom, one free body as a rule: all of the Hessian fits in registers
//! and needs no layout.

use super::jacobian::Gram;
use crate::dynamics::mass;
use crate::math::{FREE_DOFS as N, MINVAL, dot};
use crate::model::Model;

/// H = M + Jᵀ C J, of which the lower triangle is looked at.
pub(super) struct Six {
    /// The first degree of freedom.
    start: usize,
    values: [[f64; N]; N],
}

impl Six {
    /// M of the degrees of freedom from `start` on.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(super) fn new(m: &Model, inertia: &[f64], start: usize) -> Six {
        Six { start, values: mass::free_block(m, inertia, start) }
    }

    /// H⁻¹ g by H = L D Lᵀ, which waits for no square roots.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(super) fn solve(&self, g: [f64; N]) -> [f64; N] {
        let (mut l, mut inverse, mut x) = ([[0.0; N]; N], [0.0; N], g);
        for i in 0..N {
            // L D below the diagonal, then D
            let mut ld = self.values[i];
            for j in 0..i {
                for k in 0..j {
                    ld[j] -= ld[k] * l[j][k];
                }
                l[i][j] = ld[j] * inverse[j];
            }
            for k in 0..i {
                ld[i] -= ld[k] * l[i][k];
                x[i] -= l[i][k] * x[k];
            }
            inverse[i] = 1.0 / ld[i].max(MINVAL);
        }
        for i in (0..N).rev() {
            x[i] *= inverse[i];
            for k in i + 1..N {
                x[i] -= l[k][i] * x[k];
            }
        }
        x
    }
}

impl Gram for Six {
    fn place(&self, dof: u32) -> usize {
        dof as usize - self.start
    }

    fn entry(&mut self, row: usize, column: usize) -> Option<&mut f64> {
        self.values.get_mut(row)?.get_mut(column)
    }

    #[cfg_attr(not(feature = "small"), inline(always))]
    fn add_gram<const R: usize>(
        &mut self,
        columns: &[u32],
        v: &[[f64; R]],
        weigh: &dyn Fn(&[f64; R]) -> [f64; R],
    ) {
        if let (N, Some(v)) = (columns.len(), v.first_chunk::<N>()) {
            for i in 0..N {
                let w = weigh(&v[i]);
                for j in 0..=i {
                    self.values[i][j] += dot(w, v[j]);
                }
            }
            return;
        }
        for (i, (&ci, vi)) in columns.iter().zip(v).enumerate() {
            let (w, row) = (weigh(vi), &mut self.values[ci as usize - self.start]);
            for (&cj, vj) in columns[..=i].iter().zip(v) {
                row[cj as usize - self.start] += dot(w, *vj);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::array::from_fn;

    /// H x = g, for matrices of any condition.
    #[test]
    fn the_solution_solves() {
        for scale in [1.0, 1e3, 1e6] {
            let a: [[f64; N]; N] =
                from_fn(|i| from_fn(|j| ((3 * i + 5 * j * j) % 7) as f64 + scale * f64::from(i == j)));
            let values: [[f64; N]; N] = from_fn(|i| from_fn(|j| dot(a[i], a[j])));
            let g = from_fn(|i| i as f64 - 2.5);
            let x = Six { start: 0, values }.solve(g);
            for i in 0..N {
                assert!((dot(values[i], x) - g[i]).abs() < 1e-9, "{scale}: {x:?}");
            }
        }
    }
}
