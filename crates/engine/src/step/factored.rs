//! A matrix with the sparsity pattern of M and its factorization, reused between steps.

use crate::dynamics::mass;
use crate::forces::derivative::{self, sparse};
use crate::model::Model;

/// The matrix of the fast implicit integrator, and its factorization. The factorization of a tree is reused while its matrix is
/// unchanged: for slides with dampers and servos, it is the same in every step.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct FactoredMatrix {
    matrix: Vec<f64>,
    /// Whether the factorization of a tree is that of the current matrix.
    is_current: Vec<bool>,
    pub(crate) ld: Vec<f64>,
    pub(crate) diag_inv: Vec<f64>,
}

impl FactoredMatrix {
    /// Factorizes M - h D, where `whole` is D, for the trees that are not free bodies. Returns the first degree of freedom whose
    /// pivot is not positive.
    pub(crate) fn make(&mut self, m: &Model, mass: &[f64], whole: &[f64], h: f64) -> Option<usize> {
        if self.is_current.len() != m.ntree || self.ld.len() != m.nC {
            (self.matrix, self.ld) = (vec![0.0; m.nC], vec![0.0; m.nC]);
            (self.is_current, self.diag_inv) = (vec![false; m.ntree], vec![0.0; m.nv]);
        }
        let mut bad = None;
        for tree in (0..m.ntree).filter(|&t| !derivative::is_free_rigid(m, t)) {
            let dofs = m.tree_dofs(tree);
            let changed = dofs.clone().fold(false, |changed, i| {
                let row = mass::row(m, i);
                let lower = sparse::lower(m, i, row.len());
                changed | difference(&mut self.matrix[row.clone()], &mass[row], &whole[lower], h)
            });
            if self.is_current[tree] && !changed {
                continue;
            }
            let failed = mass::factor_copy(m, &self.matrix, &mut self.ld, &mut self.diag_inv, dofs);
            // A tree with a warning is factorized again at the next step, so that the warning is repeated.
            self.is_current[tree] = failed.is_none();
            bad = bad.or(failed);
        }
        bad
    }
}

/// out ← a - h b. Returns whether any bit of the result changed.
#[cfg_attr(not(feature = "small"), inline(always))]
fn difference(out: &mut [f64], a: &[f64], b: &[f64], h: f64) -> bool {
    let (n, mut changed) = (out.len(), false);
    let (a, b) = (&a[..n], &b[..n]);
    for k in 0..n {
        let current = a[k] - h * b[k];
        changed |= current.to_bits() != out[k].to_bits();
        out[k] = current;
    }
    changed
}
