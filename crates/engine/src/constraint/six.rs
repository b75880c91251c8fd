//! The Newton direction of an island with six degrees of freedom, usually one free body. The Hessian is a small dense
//! matrix and needs no layout.

use super::jacobian::HessianAccumulator;
use crate::dynamics::mass;
use crate::math::{FREE_DOFS as N, Ldl, MINVAL, dot};
use crate::model::Model;

/// H = M + Jᵀ C J. Only the lower triangle is read.
pub(super) struct Six {
    /// The first degree of freedom.
    start: usize,
    values: [[f64; N]; N],
}

impl Six {
    /// Initializes H with M for the six degrees of freedom that begin at `start`.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(super) fn new(m: &Model, inertia: &[f64], start: usize) -> Six {
        Six { start, values: mass::free_block(m, inertia, start) }
    }

    /// H⁻¹ g.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(super) fn solve(&self, g: [f64; N]) -> [f64; N] {
        Ldl::<N, 0>::raised(&self.values, MINVAL).map_or(g, |factor| factor.solve(g))
    }
}

impl HessianAccumulator for Six {
    fn place(&self, dof: u32) -> usize {
        dof as usize - self.start
    }

    fn entry(&mut self, row: usize, column: usize) -> Option<&mut f64> {
        self.values.get_mut(row)?.get_mut(column)
    }

    #[cfg_attr(not(feature = "small"), inline(always))]
    fn add_weighted_gram<const R: usize>(
        &mut self,
        columns: &[u32],
        v: &[[f64; R]],
        apply_weights: &dyn Fn(&[f64; R]) -> [f64; R],
    ) {
        if let (N, Some(v)) = (columns.len(), v.first_chunk::<N>()) {
            for i in 0..N {
                let w = apply_weights(&v[i]);
                for j in 0..=i {
                    self.values[i][j] += dot(w, v[j]);
                }
            }
            return;
        }
        for (i, (&ci, vi)) in columns.iter().zip(v).enumerate() {
            let (w, row) = (apply_weights(vi), &mut self.values[ci as usize - self.start]);
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

    /// H x = g, for matrices with different condition numbers.
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
