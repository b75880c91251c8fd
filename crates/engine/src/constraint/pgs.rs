//! Projected Gauss–Seidel with momentum on the dual problem.
//!
//! The forces f minimize ½ fᵀ (A + R) f + bᵀ f over a product of sets: all of space for equalities, intervals for dry
//! friction, half lines for limits, frictionless contacts and edges of pyramids, cones for elliptic contacts. They
//! are the minimum if and only if every group of rows that share a set is optimal for fixed forces of the others. A
//! sweep solves the groups one by one, in a new random order for each sweep (Nesterov, *Efficiency of coordinate
//! descent methods on huge-scale optimization problems*, 2012), so that no stack is always swept in an unfavourable
//! direction.
//!
//! Between sweeps the forces are extrapolated with the momentum of Beck and Teboulle (*A fast iterative
//! shrinkage-thresholding algorithm for linear inverse problems*, 2009), and projected onto their sets. The momentum
//! restarts if a sweep reverses the last change (O'Donoghue and Candès, *Adaptive restart for accelerated gradient
//! schemes*, 2015).

use super::cone::{cone_force, nearest_in_cone};
use super::cost::Cost;
use super::delassus::RowGroup;
use super::dual::MOST_SWEEPS;
use super::jacobian::JacobianBlock;
use super::primal::PrimalProblem;
use super::row_counts::{by_cone_rows, by_rows};
use crate::math::{Ldl, dot};

impl PrimalProblem<'_> {
    /// Sweeps, starting from the current forces, until one sweep improves the scaled dual objective by at most
    /// `opt.tolerance` (the documented meaning of this tolerance), or until `opt.iterations` sweeps are done.
    pub(super) fn gauss_seidel(&mut self) {
        let (tolerance, scale) = (self.m.opt.tolerance.max(0.0), self.scale_of_all());
        let price = self.sweep_cost();
        let mut order = ShuffledOrder(0);
        let mut momentum = 1.0_f64;
        self.start_sweeps();
        for _ in 0..self.m.opt.iterations.clamp(0, MOST_SWEEPS) {
            self.d.meter.add(price);
            if self.d.meter.over() {
                break;
            }
            let next = 0.5 * (1.0 + (1.0 + 4.0 * momentum * momentum).sqrt());
            self.extrapolate((momentum - 1.0) / next);
            order.shuffle(&mut self.s.dual.groups);
            let improvement = self.sweep();
            self.d.solver_niter += 1;
            if improvement.is_nan() || scale * improvement <= tolerance {
                break;
            }
            momentum = if self.has_reversed() { 1.0 } else { next };
        }
    }

    /// Lists the groups of rows, stores the current forces, and computes the acceleration that they cause.
    fn start_sweeps(&mut self) {
        self.accelerate();
        let blocks = self.blocks();
        let w = &mut self.s.dual;
        w.groups.clear();
        for i in blocks {
            let b = &self.jac.blocks[i];
            w.previous[b.rows()].copy_from_slice(&self.d.efc_force[b.rows()]);
            let rows = if matches!(b.cost, Cost::Quadratic | Cost::Cone) { b.nrow } else { 1 };
            let firsts = (0..b.nrow).step_by(rows.max(1) as usize);
            w.groups.extend(firsts.map(|first| RowGroup { block: i as u32, first }));
        }
    }

    /// y = f + β (f - previous f), projected onto the sets: the start of the next sweep.
    fn extrapolate(&mut self, beta: f64) {
        for i in self.blocks() {
            let b = self.jac.blocks[i];
            for row in b.rows() {
                let force = self.d.efc_force[row];
                self.d.efc_force[row] = force + beta * (force - self.s.dual.previous[row]);
                self.s.dual.previous[row] = force;
            }
            if beta > 0.0 {
                self.move_into_sets(&b);
            }
            self.s.dual.iterate[b.rows()].copy_from_slice(&self.d.efc_force[b.rows()]);
        }
        if beta > 0.0 {
            self.accelerate();
        }
    }

    /// Whether (y - f) · (f - previous f) > 0 in the metric of R. y - f approximates the direction of the gradient at
    /// the start of the sweep.
    fn has_reversed(&self) -> bool {
        let (d, w) = (&*self.d, &self.s.dual);
        let rows = self.blocks().flat_map(|i| self.jac.blocks[i].rows());
        let product =
            |r: usize| d.efc_R[r] * (w.iterate[r] - d.efc_force[r]) * (d.efc_force[r] - w.previous[r]);
        rows.map(product).sum::<f64>() > 0.0
    }

    /// Solves one group after the other. Returns the decrease of the dual objective.
    fn sweep(&mut self) -> f64 {
        let mut improvement = 0.0;
        for k in 0..self.s.dual.groups.len() {
            let group = self.s.dual.groups[k];
            let b = self.jac.blocks[group.block as usize];
            improvement += match (b.cost, b.nrow) {
                (Cost::Cone, n) => by_cone_rows!(n, N => self.solve_group::<N>(&b, group)),
                (Cost::Quadratic, n) if n > 1 => by_rows!(n, N => self.solve_group::<N>(&b, group)),
                _ => self.solve_row(&b, group),
            };
        }
        improvement
    }

    /// f ← the projection of f - (b + A f + R f) / (A + R) onto its set.
    fn solve_row(&mut self, b: &JacobianBlock, group: RowGroup) -> f64 {
        let row = (b.row + group.first) as usize;
        let (force, r) = (self.d.efc_force[row], self.d.efc_R[row]);
        let [[a]] = self.s.dual.delassus::<1>(b, group);
        let [residual] = self.residual::<1>(b, group);
        let (a, gradient) = (a + r, residual + r * force);
        let solved = self.nearest_in_set(b, row, force - gradient / a);
        self.set_forces(b, group, [solved]);
        let change = solved - force;
        -change * (gradient + 0.5 * a * change)
    }

    /// f ← the minimum over all of space, or over an elliptic cone, of ½ fᵀ (A + R) f + cᵀ f, where c is b plus the
    /// effect of the other forces.
    fn solve_group<const N: usize>(&mut self, b: &JacobianBlock, group: RowGroup) -> f64 {
        let row = b.row as usize;
        let (Some(&force), Some(&r)) =
            (self.d.efc_force[row..].first_chunk::<N>(), self.d.efc_R[row..].first_chunk::<N>())
        else {
            return 0.0;
        };
        let mut a = self.s.dual.delassus::<N>(b, group);
        let mut gradient = self.residual::<N>(b, group);
        for i in 0..N {
            a[i][i] += r[i];
            gradient[i] += r[i] * force[i];
        }
        let rest: [f64; N] = std::array::from_fn(|i| gradient[i] - dot(a[i], force));
        let contact = self.d.contact.get(self.d.efc_id[row] as usize).filter(|_| b.cost == Cost::Cone);
        let solved = match contact {
            Some(contact) => cone_force(&a, &rest, &contact.friction, force[0]),
            None => match Ldl::<N, 0>::positive(&a, 0.0) {
                Some(factor) => factor.solve(rest.map(|x| -x)),
                None => return 0.0,
            },
        };
        self.set_forces(b, group, solved);
        let change: [f64; N] = std::array::from_fn(|i| solved[i] - force[i]);
        -dot(change, gradient) - 0.5 * dot(change, a.map(|row| dot(row, change)))
    }

    /// Projects the forces of a block onto their sets.
    fn move_into_sets(&mut self, b: &JacobianBlock) {
        if b.cost == Cost::Cone {
            if let Some(contact) = self.d.contact.get(self.d.efc_id[b.row as usize] as usize) {
                nearest_in_cone(&mut self.d.efc_force[b.rows()], &contact.friction);
            }
        } else {
            for row in b.rows() {
                self.d.efc_force[row] = self.nearest_in_set(b, row, self.d.efc_force[row]);
            }
        }
    }

    /// The projection of the force of a row onto its set.
    fn nearest_in_set(&self, b: &JacobianBlock, row: usize, force: f64) -> f64 {
        let loss = self.d.efc_frictionloss[row];
        match b.cost {
            Cost::Quadratic => force,
            Cost::DryFriction => force.max(-loss).min(loss),
            _ => force.max(0.0),
        }
    }
}

/// Random orders that are the same in every run: the state of Knuth's linear congruential generator for MMIX (*The
/// Art of Computer Programming* 2, 3.3.4).
struct ShuffledOrder(u64);

impl ShuffledOrder {
    /// Shuffles the groups; all orders are equally likely (Knuth, 3.4.2, algorithm P).
    fn shuffle(&mut self, groups: &mut [RowGroup]) {
        for last in (1..groups.len()).rev() {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            // The high bits, which are the most random, scaled to the range of `last + 1`.
            let part = u128::from(self.0) * (last as u128 + 1);
            groups.swap(last, (part >> 64) as usize);
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a failing test prints the reason
mod tests {
    use super::{RowGroup, ShuffledOrder};
    use crate::step::step;
    use crate::step::workspace::Workspace;
    use crate::tests::compile;

    /// Balls above each other on vertical slides have elliptic cones without any friction. Extrapolated forces can
    /// lie below the apex, where they have no direction along the boundary. The sweeps must find the same motion as
    /// Newton's method.
    #[test]
    fn cones_without_friction_are_solved() {
        let heights = |solver: &str| {
            let ball = |z: f64| {
                format!("<body pos='0 0 {z}'><joint type='slide' axis='0 0 1'/><geom size='.1'/></body>")
            };
            let m = compile(&format!(
                "<mujoco><option cone='elliptic' solver='{solver}' tolerance='0' iterations='300'/><worldbody>\
                <geom type='plane' size='5 5 1'/>{}{}{}</worldbody></mujoco>",
                ball(0.3),
                ball(0.6),
                ball(0.9)
            ))
            .unwrap();
            let Workspace { fields: mut d, scratch: mut s } = Workspace::new(&m);
            (0..500).for_each(|_| step(&m, &mut d, &mut s));
            assert!((d.time - 1.0).abs() < 1e-9, "{solver}: the simulation was reset");
            d.qpos.clone()
        };
        for (a, b) in heights("PGS").iter().zip(heights("Newton")) {
            assert!((a - b).abs() < 1e-9, "{a}, {b}");
        }
    }

    #[test]
    fn orders_are_permutations_and_differ() {
        let mut groups: Vec<RowGroup> = (0..20).map(|block| RowGroup { block, first: 0 }).collect();
        let start = groups.clone();
        let mut order = ShuffledOrder(0);
        let mut seen = std::collections::BTreeSet::new();
        for _ in 0..50 {
            order.shuffle(&mut groups);
            seen.insert(groups.iter().map(|g| g.block).collect::<Vec<_>>());
            let mut sorted = groups.clone();
            sorted.sort_by_key(|g| g.block);
            assert_eq!(sorted, start);
        }
        assert_eq!(seen.len(), 50);
    }
}
