//! Matrices of the dual methods: M⁻¹ Jᵀ, and the diagonal blocks of A = J M⁻¹ Jᵀ.

use super::jacobian::{ConstraintJacobian, JacobianBlock};
use crate::dynamics::mass;
use crate::model::{Fields, Model};

/// Matrices and scratch of the dual methods.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Dual {
    /// M⁻¹ Jᵀ, in the blocks of J, with columns for all degrees of freedom of the trees that a block moves.
    pub(super) inverse: ConstraintJacobian,
    /// Diagonal blocks of A, row-major, and the start of each.
    pub(super) delassus_blocks: Vec<f64>,
    pub(super) start: Vec<u32>,
    /// M⁻¹ Jᵀ f.
    pub(super) acceleration: Vec<f64>,
    /// A column of M⁻¹ Jᵀ.
    pub(super) x: Vec<f64>,
    /// The forces at the start of the current sweep, and those after the previous sweep.
    pub(super) iterate: Vec<f64>,
    pub(super) previous: Vec<f64>,
    /// The row groups that a sweep solves, in order.
    pub(super) groups: Vec<RowGroup>,
}

/// Rows that are solved together: a single row, or all rows of an equality or an elliptic cone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RowGroup {
    pub(super) block: u32,
    /// First row, relative to the first row of the block.
    pub(super) first: u32,
}

impl Dual {
    /// Computes M⁻¹ Jᵀ and the diagonal blocks of A.
    pub(super) fn build(&mut self, m: &Model, d: &Fields, jac: &ConstraintJacobian) {
        self.inverse.clear();
        self.delassus_blocks.clear();
        self.start.clear();
        self.acceleration.resize(m.nv, 0.0);
        self.x.resize(m.nv, 0.0);
        for v in [&mut self.iterate, &mut self.previous] {
            v.resize(d.nefc, 0.0);
        }
        for b in &jac.blocks {
            self.block(m, d, jac, b);
        }
    }

    fn block(&mut self, m: &Model, d: &Fields, jac: &ConstraintJacobian, b: &JacobianBlock) {
        let n = b.nrow as usize;
        let trees = jac.trees(m, b);
        let values = self.inverse.push_zeros(b, trees.clone().flat_map(|t| m.tree_dofs(t)));
        let terms = || jac.terms(b);
        self.start.push(self.delassus_blocks.len() as u32);
        for r in 0..n {
            for t in trees.clone() {
                self.x[m.tree_dofs(t)].fill(0.0);
            }
            for (&k, v) in terms() {
                self.x[k as usize] = v[r];
            }
            for t in trees.clone() {
                mass::solve(m, &d.qLD, &d.qLDiagInv, &mut self.x, m.tree_dofs(t));
            }
            let dofs = trees.clone().flat_map(|t| m.tree_dofs(t));
            for (value, k) in values.chunks_exact_mut(n).zip(dofs) {
                value[r] = self.x[k];
            }
            let row = self.delassus_blocks.len();
            self.delassus_blocks.resize(row + n, 0.0);
            for (&k, v) in terms() {
                for (sum, v) in self.delassus_blocks[row..].iter_mut().zip(v) {
                    *sum += v * self.x[k as usize];
                }
            }
        }
    }

    /// The diagonal block of A for N rows.
    pub(super) fn delassus<const N: usize>(&self, b: &JacobianBlock, group: RowGroup) -> [[f64; N]; N] {
        let (start, n) = (self.start[group.block as usize] as usize, b.nrow as usize);
        let first = group.first as usize;
        std::array::from_fn(|i| {
            std::array::from_fn(|j| self.delassus_blocks[start + (first + i) * n + first + j])
        })
    }
}
