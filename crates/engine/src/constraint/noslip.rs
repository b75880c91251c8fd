//! Removal of slip: friction is solved again without softness, with the other forces of the solver unchanged.
//!
//! The softness R lets contacts creep. Without it, the friction f_t minimizes ½ f_tᵀ A f_t + (b + A f_rest)ᵀ f_t
//! under limits given by the other forces: the largest force of dry friction, and μ times the normal force of a
//! contact, which does not change. The minimum is found by Gauss–Seidel sweeps over the constraints (`pgs`). Each
//! constraint is solved to its optimality conditions.

use super::cone::friction;
use super::cost::Cost;
use super::delassus::RowGroup;
use super::dual::MOST_SWEEPS;
use super::jacobian::JacobianBlock;
use super::kind;
use super::primal::PrimalProblem;
use super::row_counts::by_cone_rows;
use crate::math::broken_invariant;
use crate::math::dot;

impl PrimalProblem<'_> {
    /// Sweeps over the friction rows of the island until one sweep improves the scaled dual objective by at most
    /// `opt.noslip_tolerance` (0 if it is negative), or until `opt.noslip_iterations` sweeps are done.
    pub(super) fn remove_slip(&mut self) {
        let (tolerance, scale) = (self.m.opt.noslip_tolerance.max(0.0), self.scale_of_all());
        let price = self.sweep_cost();
        self.accelerate();
        for _ in 0..self.m.opt.noslip_iterations.clamp(0, MOST_SWEEPS) {
            self.d.meter.add(price);
            if self.d.meter.over() {
                break;
            }
            let mut improvement = 0.0;
            for i in self.blocks() {
                let b = self.jac.blocks[i];
                let group = RowGroup { block: i as u32, first: 0 };
                improvement += match (b.cost, self.d.efc_type[b.row as usize]) {
                    (Cost::DryFriction, _) => self.rigid_dry_friction(&b, group),
                    (Cost::Cone, _) => by_cone_rows!(b.nrow, N => self.rigid_cone::<N>(&b, group)),
                    (_, kind::CONTACT_PYRAMIDAL) => self.rigid_pyramid(&b, group),
                    _ => 0.0,
                };
            }
            self.d.solver_niter += 1;
            if improvement.is_nan() || scale * improvement <= tolerance {
                break;
            }
        }
    }

    /// Solves dry friction of a joint or tendon: |f| ≤ `efc_frictionloss`. Returns the improvement, like the
    /// functions below.
    fn rigid_dry_friction(&mut self, b: &JacobianBlock, group: RowGroup) -> f64 {
        let row = b.row as usize;
        let (force, loss) = (self.d.efc_force[row], self.d.efc_frictionloss[row]);
        let [[curvature]] = self.s.dual.delassus::<1>(b, group);
        let [slope] = self.residual::<1>(b, group);
        let solved = minimum_within(force, slope, curvature, loss);
        self.set_forces(b, group, [solved]);
        improvement(solved - force, slope, curvature)
    }

    /// Solves the friction of an elliptic cone for its normal force.
    fn rigid_cone<const N: usize>(&mut self, b: &JacobianBlock, group: RowGroup) -> f64 {
        let row = b.row as usize;
        let Some(&force) = self.d.efc_force[row..].first_chunk::<N>() else {
            return broken_invariant("every row of a block has a force");
        };
        let Some(contact) = self.d.contact.get(self.d.efc_id[row] as usize) else {
            return broken_invariant("the rows of a cone are those of a contact");
        };
        let mu = contact.friction;
        let a = self.s.dual.delassus::<N>(b, group);
        let slope = self.residual::<N>(b, group);
        let normal = force[0];
        let mut solved = [0.0; N];
        if normal > 0.0 {
            let mut tangents = force;
            tangents[0] = 0.0;
            let rest = std::array::from_fn(|i| slope[i] - dot(a[i], tangents));
            solved = friction(&a, &rest, &mu, normal);
        }
        solved[0] = normal;
        self.set_forces(b, group, solved);
        let change: [f64; N] = std::array::from_fn(|i| solved[i] - force[i]);
        -dot(change, slope) - 0.5 * dot(change, a.map(|row| dot(row, change)))
    }

    /// Solves each pair of opposite edges of a pyramid. Their forces are n ± y, where n, half of their sum, is
    /// constant and |y| ≤ n.
    fn rigid_pyramid(&mut self, b: &JacobianBlock, group: RowGroup) -> f64 {
        let mut decrease = 0.0;
        for first in (0..b.nrow).step_by(2) {
            let group = RowGroup { first, ..group };
            let row = (b.row + first) as usize;
            let Some(&[left, right]) = self.d.efc_force[row..].first_chunk::<2>() else { break };
            let [[a00, a01], [a10, a11]] = self.s.dual.delassus::<2>(b, group);
            let [r0, r1] = self.residual::<2>(b, group);
            let (n, y) = (0.5 * (left + right), 0.5 * (left - right));
            let (slope, curvature) = (r0 - r1, a00 + a11 - a01 - a10);
            let solved = minimum_within(y, slope, curvature, n);
            let edges = [n + solved, n - solved];
            self.set_forces(b, group, edges);
            // Only the change that the stored edge forces represent counts: next to a large n, its last digits or all
            // of it may be lost to rounding.
            decrease += improvement(0.5 * (edges[0] - edges[1]) - y, slope, curvature);
        }
        decrease
    }
}

/// The minimum within ±`limit` of a parabola with the given slope and curvature at x. Without curvature, it is x.
fn minimum_within(x: f64, slope: f64, curvature: f64, limit: f64) -> f64 {
    let free = if curvature > 0.0 { x - slope / curvature } else { x };
    free.max(-limit).min(limit)
}

/// The decrease of this parabola for a change of x.
fn improvement(change: f64, slope: f64, curvature: f64) -> f64 {
    -change * (slope + 0.5 * curvature * change)
}
