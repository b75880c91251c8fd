//! The removal of slip: after the solver the forces of friction alone are solved again as if they were rigid, by sweeps
//! over the dual problem without regularization.

use super::cone::friction;
use super::cost::Cost;
use super::gram::Item;
use super::jacobian::{Block, by_cone_rows};
use super::kind;
use super::pgs::WORSE;
use super::primal::Problem;
use crate::math::{MINVAL, dot};

/// Least diagonal of A between directions of friction.
const RIGID: f64 = 1e-10;

/// Determinant of two or three directions of friction, or pivot of more, below which the library drops the friction of a
/// contact altogether (measured on MuJoCo 3.14.0): a matrix that is singular, or only small, as small coefficients make it.
const DROPPED: f64 = 1e-10;

/// Whether a contact gets no friction, by the matrix of its tangents scaled by their coefficients.
fn is_dropped<const N: usize>(a: &[[f64; N]; N], mu: &[f64; 5]) -> bool {
    let mut g: [[f64; N]; N] = std::array::from_fn(|i| {
        std::array::from_fn(|j| if i == 0 || j == 0 { 0.0 } else { a[i][j] * mu[i - 1] * mu[j - 1] })
    });
    let mut determinant = 1.0;
    let mut least = f64::INFINITY;
    // Elimination without exchange: the matrix is symmetric and not negative.
    for k in 1..N {
        let pivot = g[k][k];
        (determinant, least) = (determinant * pivot, least.min(pivot));
        if pivot <= 0.0 {
            break;
        }
        for i in k + 1..N {
            let part = g[i][k] / pivot;
            for j in k + 1..N {
                g[i][j] -= part * g[k][j];
            }
        }
    }
    least <= 0.0 || if N <= 4 { determinant < DROPPED } else { least < DROPPED }
}

impl Problem<'_> {
    /// Changes the forces of friction of the island.
    pub(super) fn remove_slip(&mut self) {
        let (tol, scale) = (self.m.opt.noslip_tolerance, self.scale_of_all());
        self.accelerate();
        // Without regularization the cost is lower from the start.
        let d = &*self.d;
        let rows = self.blocks().flat_map(|i| self.jac.blocks[i].rows());
        let mut improvement: f64 = rows.map(|r| 0.5 * d.efc_force[r] * d.efc_force[r] * d.efc_R[r]).sum();
        let price = self.price_of_sweep();
        for _ in 0..self.m.opt.noslip_iterations.max(0) {
            self.d.meter.add(price);
            if self.d.meter.over() {
                break;
            }
            for i in self.blocks() {
                let b = self.jac.blocks[i];
                let item = Item { block: i as u32, first: 0 };
                improvement -= match (b.cost, self.d.efc_type[b.row as usize]) {
                    (Cost::DryFriction, _) => self.rigid_friction(&b, item),
                    (Cost::Cone, _) => by_cone_rows!(b.nrow, R => self.rigid_cone::<R>(&b, item)),
                    (_, kind::CONTACT_PYRAMIDAL) => self.rigid_pyramid(&b, item),
                    _ => 0.0,
                };
            }
            self.d.solver_niter += 1;
            if scale * improvement < tol {
                break;
            }
            improvement = 0.0;
        }
    }

    /// Dry friction of a joint or tendon; returns the change of the cost.
    fn rigid_friction(&mut self, b: &Block, item: Item) -> f64 {
        let row = b.row as usize;
        let (old, loss) = (self.d.efc_force[row], self.d.efc_frictionloss[row]);
        let [[a]] = self.s.dual.part::<1>(b, item);
        let a = a.max(MINVAL);
        let [missed] = self.missed::<1>(b, item);
        let new = (old - missed / a).max(-loss).min(loss);
        let change = new - old;
        self.replace(b, item, [new]);
        change * (0.5 * change * a + missed)
    }

    /// The friction of an elliptic cone, with its normal force as it is.
    fn rigid_cone<const R: usize>(&mut self, b: &Block, item: Item) -> f64 {
        let row = b.row as usize;
        let Some(&old) = self.d.efc_force[row..].first_chunk::<R>() else { return 0.0 };
        let Some(mu) = self.d.contact.get(self.d.efc_id[row] as usize).map(|c| c.friction) else {
            return 0.0;
        };
        let mut a = self.s.dual.part::<R>(b, item);
        for (i, row) in a.iter_mut().enumerate() {
            row[i] = row[i].max(RIGID);
        }
        let missed = self.missed::<R>(b, item);
        let mut new = [0.0; R];
        if old[0] >= MINVAL && !is_dropped(&a, &mu) {
            let mut rest = old.map(|f| -f);
            rest[0] = 0.0;
            let without: [f64; R] = std::array::from_fn(|i| missed[i] + dot(a[i], rest));
            new = friction(&a, &without, &mu, old[0]);
        }
        new[0] = old[0];
        let change: [f64; R] = std::array::from_fn(|i| new[i] - old[i]);
        let curved: [f64; R] = std::array::from_fn(|i| dot(a[i], change));
        let cost = 0.5 * dot(change, curved) + dot(change, missed);
        if cost > WORSE {
            return 0.0;
        }
        self.replace(b, item, new);
        cost
    }

    /// Each pair of opposite edges of a pyramid: force goes from one to the other, their sum stays.
    fn rigid_pyramid(&mut self, b: &Block, item: Item) -> f64 {
        let mut cost = 0.0;
        for first in (0..b.nrow).step_by(2) {
            let item = Item { first, ..item };
            let row = (b.row + first) as usize;
            let Some(&old) = self.d.efc_force[row..].first_chunk::<2>() else { return cost };
            let mut a = self.s.dual.part::<2>(b, item);
            for (i, row) in a.iter_mut().enumerate() {
                row[i] = row[i].max(RIGID);
            }
            let missed = self.missed::<2>(b, item);
            // The forces are mid ± y.
            let mid = 0.5 * (old[0] + old[1]);
            let curvature = a[0][0] + a[1][1] - a[0][1] - a[1][0];
            let y = if curvature < MINVAL {
                0.0
            } else {
                let now = 0.5 * (old[0] - old[1]);
                (now - (missed[0] - missed[1]) / curvature).max(-mid).min(mid)
            };
            let new = [mid + y, mid - y];
            let change = [new[0] - old[0], new[1] - old[1]];
            cost += 0.5 * dot(change, [dot(a[0], change), dot(a[1], change)]) + dot(change, missed);
            self.replace(b, item, new);
        }
        cost
    }
}
