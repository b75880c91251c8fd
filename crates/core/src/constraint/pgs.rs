//! Projected Gauss–Seidel on the dual problem.
//!
//! A sweep minimizes over one force after the other, in a random order with a fixed seed, so that rows which work
//! against each other do not always come in the same one. Between sweeps the forces are extrapolated (Nesterov 1983),
//! and the extrapolation begins anew where a sweep turns against it (O'Donoghue and Candès 2015).

use super::cone::friction;
use super::cost::Cost;
use super::gram::Item;
use super::jacobian::{Block, by_cone_rows};
use super::primal::Problem;
use crate::math::{MINVAL, dot};

/// Increases of the cost by more than this are taken back.
pub(super) const WORSE: f64 = 1e-10;

/// O'Neill's generator PCG32 (*PCG: A family of simple fast space-efficient statistically good algorithms for random
/// number generation*, 2014), stream 0 and seed 0.
struct Random(u64);

impl Random {
    fn new() -> Random {
        let mut random = Random(0);
        random.next();
        random
    }

    fn next(&mut self) -> u32 {
        let state = self.0;
        self.0 = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        ((((state >> 18) ^ state) >> 27) as u32).rotate_right((state >> 59) as u32)
    }
}

impl Problem<'_> {
    /// Goes on from the forces that are there.
    pub(super) fn gauss_seidel(&mut self) {
        let (tol, scale) = (self.m.opt.tolerance, self.scale_of_all());
        self.list_items();
        self.copy_forces(|w| &mut w.last);
        self.copy_forces(|w| &mut w.before);
        let (mut random, mut since) = (Random::new(), 0u32);
        let price = self.price_of_sweep();
        for _ in 0..self.m.opt.iterations.max(0) {
            self.d.meter.add(price);
            if self.d.meter.over() {
                break;
            }
            for i in (1..self.s.dual.order.len()).rev() {
                let j = random.next() as usize % (i + 1);
                self.s.dual.order.swap(i, j);
            }
            let momentum = (f64::from(since) - 1.0) / (f64::from(since) + 2.0);
            let moves = momentum > 0.0;
            if moves {
                self.extrapolate(momentum);
            }
            self.copy_forces(|w| &mut w.begun);
            self.accelerate();
            let mut improvement = 0.0;
            for i in 0..self.s.dual.order.len() {
                let item = self.s.dual.order[i];
                let b = self.jac.blocks[item.block as usize];
                improvement -= match b.cost {
                    Cost::Cone => by_cone_rows!(b.nrow, R => self.cone::<R>(&b, item)),
                    _ => self.single(&b, item),
                };
            }
            self.d.solver_niter += 1;
            since = if moves && self.turned() { 0 } else { since + 1 };
            let w = &mut self.s.dual;
            std::mem::swap(&mut w.last, &mut w.before);
            self.copy_forces(|w| &mut w.last);
            if scale * improvement < tol || improvement == 0.0 {
                break;
            }
        }
    }

    /// Copies the forces of the island to one of the lists that are kept.
    fn copy_forces(&mut self, to: impl Fn(&mut super::gram::Dual) -> &mut Vec<f64>) {
        for i in self.blocks() {
            let rows = self.jac.blocks[i].rows();
            to(&mut self.s.dual)[rows.clone()].copy_from_slice(&self.d.efc_force[rows]);
        }
    }

    /// Forces go on as between the last two sweeps, as far as they may.
    fn extrapolate(&mut self, momentum: f64) {
        for i in 0..self.s.dual.order.len() {
            let item = self.s.dual.order[i];
            let b = self.jac.blocks[item.block as usize];
            let first = (b.row + item.first) as usize;
            let rows = if b.cost == Cost::Cone { first..first + b.nrow as usize } else { first..first + 1 };
            let w = &self.s.dual;
            for r in rows.clone() {
                self.d.efc_force[r] = w.last[r] + momentum * (w.last[r] - w.before[r]);
            }
            if b.cost == Cost::Cone {
                let Some(c) = self.d.contact.get(self.d.efc_id[first] as usize) else { continue };
                into_cone(&mut self.d.efc_force[rows], &c.friction);
            } else {
                self.d.efc_force[first] = self.allowed(&b, first, self.d.efc_force[first]);
            }
        }
    }

    /// The nearest force that a row may have.
    fn allowed(&self, b: &Block, row: usize, force: f64) -> f64 {
        let loss = self.d.efc_frictionloss[row];
        match b.cost {
            Cost::Quadratic => force,
            Cost::DryFriction => force.max(-loss).min(loss),
            _ => force.max(0.0),
        }
    }

    /// Whether the sweep went against the extrapolation.
    fn turned(&self) -> bool {
        let (d, w) = (&*self.d, &self.s.dual);
        let rows = self.blocks().flat_map(|i| self.jac.blocks[i].rows());
        rows.map(|r| (w.begun[r] - d.efc_force[r]) * (w.begun[r] - w.last[r])).sum::<f64>() > 0.0
    }

    /// The best force of one row; returns the change of the cost.
    fn single(&mut self, b: &Block, item: Item) -> f64 {
        let row = (b.row + item.first) as usize;
        let (old, r) = (self.d.efc_force[row], self.d.efc_R[row]);
        let [[a]] = self.s.dual.part::<1>(b, item);
        let [missed] = self.missed::<1>(b, item);
        let (a, missed) = (a + r, missed + r * old);
        let new = self.allowed(b, row, old - missed / a);
        let change = new - old;
        let cost = change * (0.5 * change * a + missed);
        if cost > WORSE {
            return 0.0;
        }
        self.replace(b, item, [new]);
        cost
    }

    /// The forces of an elliptic cone: along the ray that they are on, then friction for the normal force that this gives.
    fn cone<const R: usize>(&mut self, b: &Block, item: Item) -> f64 {
        let row = b.row as usize;
        let (Some(&old), Some(&r)) =
            (self.d.efc_force[row..].first_chunk::<R>(), self.d.efc_R[row..].first_chunk::<R>())
        else {
            return 0.0;
        };
        let Some(mu) = self.d.contact.get(self.d.efc_id[row] as usize).map(|c| c.friction) else {
            return 0.0;
        };
        let mut a = self.s.dual.part::<R>(b, item);
        let mut missed = self.missed::<R>(b, item);
        for i in 0..R {
            a[i][i] += r[i];
            missed[i] += r[i] * old[i];
        }
        let product = |v: &[f64; R]| -> [f64; R] { std::array::from_fn(|i| dot(a[i], *v)) };
        let mut new = old;
        if old[0] < MINVAL {
            new = [0.0; R];
            new[0] = (old[0] - missed[0] / a[0][0]).max(0.0);
            if new[0] < MINVAL {
                new = from_apex(&missed, &mu, product);
            }
        } else {
            let curvature = dot(old, product(&old));
            if curvature >= MINVAL {
                // As far as the apex at most.
                let along = (-dot(old, missed) / curvature).max(-1.0);
                new = old.map(|f| f + along * f);
            }
        }
        if new[0] < MINVAL {
            new.fill(0.0);
        } else {
            // What the tangents would miss with no friction, but the new normal force.
            let mut rest = old.map(|f| -f);
            rest[0] = new[0] - old[0];
            let missed: [f64; R] = std::array::from_fn(|i| missed[i] + dot(a[i], rest));
            let normal = new[0];
            new = friction(&a, &missed, &mu, normal);
            new[0] = normal;
        }
        let change: [f64; R] = std::array::from_fn(|i| new[i] - old[i]);
        let cost = 0.5 * dot(change, product(&change)) + dot(change, missed);
        if cost > WORSE {
            return 0.0;
        }
        self.replace(b, item, new);
        cost
    }
}

/// The best force along the steepest ray of the cone, from its apex: a push that alone would not pay may pay with the
/// friction that it allows.
fn from_apex<const R: usize>(
    missed: &[f64; R],
    mu: &[f64; 5],
    product: impl Fn(&[f64; R]) -> [f64; R],
) -> [f64; R] {
    let pull = missed[1..].iter().zip(mu).map(|(x, mu)| (x * mu) * (x * mu)).sum::<f64>().sqrt();
    let slope = missed[0] - pull;
    if slope >= 0.0 || pull < MINVAL {
        return [0.0; R];
    }
    let mut ray = [1.0; R];
    for ((t, x), mu) in ray[1..].iter_mut().zip(&missed[1..]).zip(mu) {
        *t = -x * mu * mu / pull;
    }
    let along = -slope / dot(ray, product(&ray)).max(MINVAL);
    ray.map(|x| x * along)
}

/// The force moved into its cone: none where it would pull, else with friction scaled down.
fn into_cone(force: &mut [f64], mu: &[f64; 5]) {
    let Some((normal, tangents)) = force.split_first_mut() else { return };
    *normal = normal.max(0.0);
    let size = tangents.iter().zip(mu).map(|(f, mu)| (f / mu) * (f / mu)).sum::<f64>().sqrt();
    if size > *normal {
        let onto = *normal / size;
        tangents.iter_mut().for_each(|f| *f *= onto);
    }
}

#[cfg(test)]
mod tests {
    use super::{Random, into_cone};

    #[test]
    fn random_numbers_are_those_of_pcg32() {
        // The generator's own demonstration, seeded with 42 on stream 54, begins with these numbers.
        let demo = |state: u64| ((((state >> 18) ^ state) >> 27) as u32).rotate_right((state >> 59) as u32);
        let step = |s: u64| s.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(109);
        let mut state = step(step(0).wrapping_add(42));
        for expected in [0xa15c_02b7_u32, 0x7b47_f409, 0xba1d_3330] {
            assert_eq!(demo(state), expected);
            state = step(state);
        }
        let mut random = Random::new();
        let first = random.next();
        assert_eq!((first, random.next()), (demo(1), demo(6_364_136_223_846_793_006)));
    }

    #[test]
    fn forces_come_into_their_cone() {
        let mu = [0.5, 0.25, 1.0, 1.0, 1.0];
        for (force, expected) in [
            ([1.0, 0.1, 0.1], [1.0, 0.1, 0.1]),
            ([1.0, 5.0, 0.0], [1.0, 0.5, 0.0]),
            ([1.0, 0.0, -5.0], [1.0, 0.0, -0.25]),
            ([-1.0, 5.0, 1.0], [0.0, 0.0, 0.0]),
        ] {
            let mut f = force;
            into_cone(&mut f, &mu);
            assert_eq!(f, expected);
        }
    }
}
