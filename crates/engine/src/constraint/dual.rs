//! The dual problem of one island. Its unknowns are the constraint forces.
//!
//! min over f of ½ fᵀ (A + R) f + bᵀ f with A = J M⁻¹ Jᵀ, where b is the deviation of the unconstrained acceleration
//! from the reference, and each force is limited to its admissible set. A is never formed: the acceleration M⁻¹ Jᵀ f
//! is updated with every change of a force, as in the impulse-based solvers of Mirtich and Canny and of Erleben. Only
//! the diagonal blocks of A are stored.

use super::delassus::RowGroup;
use super::jacobian::JacobianBlock;
use super::primal::PrimalProblem;
use super::row_counts::by_rows;
use crate::dynamics::mass;
use crate::math::broken_invariant;

/// Maximum number of sweeps over the rows, whatever a model requests, so that a step terminates even without a work
/// limit.
pub(super) const MOST_SWEEPS: i32 = 100_000;

impl PrimalProblem<'_> {
    /// Work units of one sweep over the forces of the island.
    pub(super) fn sweep_cost(&self) -> u64 {
        let [blocks, _, values] = self.s.dual.inverse.size();
        let own_blocks = self.islands.blocks.len(self.island) as u64;
        6 * self.pass_costs()[0] + own_blocks * (100 + 4 * values / blocks.max(1))
    }

    /// `acceleration` ← M⁻¹ Jᵀ f of the island.
    pub(super) fn accelerate(&mut self) {
        for dofs in self.dofs() {
            self.s.dual.acceleration[dofs].fill(0.0);
        }
        for i in self.blocks() {
            let b = self.s.dual.inverse.blocks[i];
            by_rows!(b.nrow, R => {
                let w = &mut self.s.dual;
                if let Some(f) = self.d.efc_force[b.rows()].first_chunk::<R>() {
                    w.inverse.add_transposed(&b, f, &mut w.acceleration);
                }
            });
        }
    }

    /// b + A f of N rows: the deviation of the acceleration from the reference.
    #[inline]
    pub(super) fn residual<const N: usize>(&self, b: &JacobianBlock, group: RowGroup) -> [f64; N] {
        let first = group.first as usize;
        let mut sums = [0.0; N];
        for (&k, v) in self.jac.terms(b) {
            let a = self.s.dual.acceleration[k as usize];
            if let Some(v) = v[first..].first_chunk::<N>() {
                (0..N).for_each(|r| sums[r] += v[r] * a);
            }
        }
        for (sum, b) in sums.iter_mut().zip(&self.d.efc_b[b.row as usize + first..]) {
            *sum += b;
        }
        sums
    }

    /// Sets the forces of N rows.
    #[inline]
    pub(super) fn set_forces<const N: usize>(&mut self, b: &JacobianBlock, group: RowGroup, force: [f64; N]) {
        let first = group.first as usize;
        let row = b.row as usize + first;
        let Some(old) = self.d.efc_force[row..].first_chunk_mut::<N>() else {
            return broken_invariant("every row of a block has a force");
        };
        let change: [f64; N] = std::array::from_fn(|r| force[r] - old[r]);
        if change == [0.0; N] {
            return;
        }
        *old = force;
        let w = &mut self.s.dual;
        let wide = &w.inverse.blocks[group.block as usize];
        w.inverse.add_rows_transposed(wide, first, &change, &mut w.acceleration);
    }

    /// ½ fᵀ (A + R) f + bᵀ f of the island.
    pub(super) fn dual_cost(&mut self) -> f64 {
        self.accelerate();
        let mut cost = 0.0;
        for i in self.blocks() {
            let b = self.jac.blocks[i];
            for first in 0..b.nrow {
                let row = (b.row + first) as usize;
                let group = RowGroup { block: i as u32, first };
                let [residual] = self.residual::<1>(&b, group);
                let (f, d) = (self.d.efc_force[row], &*self.d);
                // ½ f (b + A f), and ½ f b.
                cost += 0.5 * f * (residual + d.efc_b[row] + d.efc_R[row] * f);
            }
        }
        cost
    }

    /// `qfrc_constraint` and `qacc` from the forces.
    pub(super) fn finish_dual(&mut self) {
        for dofs in self.dofs() {
            self.d.qfrc_constraint[dofs].fill(0.0);
        }
        for i in self.blocks() {
            let b = self.jac.blocks[i];
            by_rows!(b.nrow, R => {
                let d = &mut *self.d;
                if let Some(f) = d.efc_force[b.rows()].first_chunk::<R>() {
                    self.jac.add_transposed(&b, f, &mut d.qfrc_constraint);
                }
            });
        }
        for dofs in self.dofs() {
            let (m, d, s) = (self.m, &mut *self.d, &mut *self.s);
            s.step[dofs.clone()].copy_from_slice(&d.qfrc_constraint[dofs.clone()]);
            mass::solve(m, &d.qLD, &d.qLDiagInv, &mut s.step, dofs.clone());
            for k in dofs {
                d.qacc[k] = d.qacc_smooth[k] + s.step[k];
            }
        }
        for i in self.blocks() {
            let d = &*self.d;
            let b = &self.jac.blocks[i];
            self.jac.mul_block(b, &d.qacc, &mut self.s.jar);
            for (x, aref) in self.s.jar[b.rows()].iter_mut().zip(&d.efc_aref[b.rows()]) {
                *x -= aref;
            }
        }
    }
}
