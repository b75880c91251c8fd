//! The removal of slip: friction is solved again as if it were rigid, with what the solver found for everything else.
//!
//! The softness R lets a contact creep. Without it the friction f_t minimizes ½ f_tᵀ A f_t + (b + A f_rest)ᵀ f_t under the limits
//! that the other forces set: the largest force of dry friction, and μ times the normal force of a contact, which stays. The minimum
//! is found by sweeps of Gauss and Seidel over the constraints (`pgs`), each solved to its optimality conditions.

use super::cone::friction;
use super::cost::Cost;
use super::delassus::RowGroup;
use super::dual::MOST_SWEEPS;
use super::jacobian::Block;
use super::kind;
use super::primal::Problem;
use super::row_counts::by_cone_rows;
use crate::math::broken_invariant;
use crate::math::dot;

impl Problem<'_> {
    /// Sweeps over the friction of the island until one improves the scaled dual objective by no more than
    /// `opt.noslip_tolerance` (0 where it is negative) or `opt.noslip_iterations` of them are done.
    pub(super) fn remove_slip(&mut self) {
        let (tolerance, scale) = (self.m.opt.noslip_tolerance.max(0.0), self.scale_of_all());
        let price = self.price_of_sweep();
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

    /// Dry friction of a joint or tendon: |f| ≤ `efc_frictionloss`.
    fn rigid_dry_friction(&mut self, b: &Block, group: RowGroup) -> f64 {
        let row = b.row as usize;
        let (force, loss) = (self.d.efc_force[row], self.d.efc_frictionloss[row]);
        let [[curvature]] = self.s.dual.delassus::<1>(b, group);
        let [slope] = self.residual::<1>(b, group);
        let solved = minimum_within(force, slope, curvature, loss);
        self.set_forces(b, group, [solved]);
        improvement(solved - force, slope, curvature)
    }

    /// The friction of an elliptic cone under its normal force.
    fn rigid_cone<const N: usize>(&mut self, b: &Block, group: RowGroup) -> f64 {
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

    /// Each pair of opposite edges of a pyramid: the forces are n ± y, where n, half their sum, stays and |y| ≤ n.
    fn rigid_pyramid(&mut self, b: &Block, group: RowGroup) -> f64 {
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
            // Only what the edges keep of the change counts: beside a large n its last digits are lost, or all of it.
            decrease += improvement(0.5 * (edges[0] - edges[1]) - y, slope, curvature);
        }
        decrease
    }
}

/// Where a parabola with this slope and curvature at x is least within ±`limit`; x itself where it is flat.
fn minimum_within(x: f64, slope: f64, curvature: f64, limit: f64) -> f64 {
    let free = if curvature > 0.0 { x - slope / curvature } else { x };
    free.max(-limit).min(limit)
}

/// The decrease of the same parabola over a change of x.
fn improvement(change: f64, slope: f64, curvature: f64) -> f64 {
    -change * (slope + 0.5 * curvature * change)
}
