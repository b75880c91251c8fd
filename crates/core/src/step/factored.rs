//! A matrix with the pattern of M and its factorization, kept from one step to the next.

use crate::dynamics::mass;
use crate::forces::derivative;
use crate::math::same_bits;
use crate::model::Model;

/// The matrix of the fast implicit integrator, and its factorization, which stays as long as the matrix does, tree by tree: that of
/// slides with dampers and servos is the same in every step.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Factored {
    of: Vec<f64>,
    /// Whether the rows of a tree have been factorized.
    known: Vec<bool>,
    pub(crate) ld: Vec<f64>,
    pub(crate) diag_inv: Vec<f64>,
}

impl Factored {
    /// Factorizes the rows of the trees that are not free bodies. Returns the first degree of freedom whose D is not positive.
    pub(crate) fn make(&mut self, m: &Model, matrix: &[f64]) -> Option<usize> {
        if self.known.len() != m.ntree || self.ld.len() != m.nC {
            (self.of, self.ld) = (vec![0.0; m.nC], vec![0.0; m.nC]);
            (self.known, self.diag_inv) = (vec![false; m.ntree], vec![0.0; m.nv]);
        }
        let mut bad = None;
        for tree in (0..m.ntree).filter(|&t| !derivative::is_free_rigid(m, t)) {
            let dofs = m.tree_dofs(tree);
            let rows = mass::rows_of(m, dofs.clone());
            if self.known[tree] && same_bits(&self.of[rows.clone()], &matrix[rows.clone()]) {
                continue;
            }
            self.of[rows.clone()].copy_from_slice(&matrix[rows]);
            let failed = mass::factor_copy(m, matrix, &mut self.ld, &mut self.diag_inv, dofs);
            // One that warns is factorized again at the next step, and warns again.
            self.known[tree] = failed.is_none();
            bad = bad.or(failed);
        }
        bad
    }
}
