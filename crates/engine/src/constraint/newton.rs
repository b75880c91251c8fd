//! Newton's method: the direction -H⁻¹ g with H = M + Jᵀ C J, where C is the second derivative of the costs.
//!
//! The cost is convex and, except for elliptic cones, piecewise quadratic, so the method terminates after finitely
//! many steps (Nocedal and Wright 2006, ch. 3).

use super::cost::{Cost, Curvature, unilateral_curvature};
use super::iterate::IslandProgress;
use super::jacobian::{ConstraintJacobian, HessianAccumulator, JacobianBlock, add_entries};
use super::primal::{Direction, PrimalProblem, shape};
use super::row_counts::by_rows;
use super::six::Six;
use crate::math::{FREE_DOFS, SMALL, dot};
use crate::model::Fields;
use std::array::from_fn;
use std::ops::Range;

impl PrimalProblem<'_> {
    #[inline(never)]
    pub(super) fn newton(&mut self, from: IslandProgress) {
        if from.minimum {
            return;
        }
        let six = self.islands.one_run(self.island).filter(|dofs| dofs.len() == FREE_DOFS);
        if six.is_none() && !self.compute_layout() {
            return self.conjugate_gradient(from);
        }
        let [rows, products] = self.pass_costs();
        let price = 4 * rows + products + if six.is_some() { 200 } else { self.s.hessian.work };
        self.d.meter.add(price);
        let tol = self.m.opt.tolerance;
        let IslandProgress { gradient, scale, .. } = from;
        self.descend(from, price, |p, before| {
            p.newton_direction(&six);
            // While the gradient is large, the first direction is always taken.
            let small = before.is_some() || scale * gradient < tol;
            let decrement = p.decrement();
            let done = small && scale * decrement < tol;
            (!done).then_some(Direction::Newton { slope: -2.0 * decrement, first: before.is_none() })
        });
    }

    /// Computes the layout of the Hessian of the island. Returns `false` if the Hessian is too expensive.
    fn compute_layout(&mut self) -> bool {
        let s = &mut *self.s;
        s.select_island(self.island);
        let fits = s.hessian.compute_layout(self.m, self.jac, self.islands, self.island);
        s.rhs.clear();
        s.rhs.resize(s.hessian.capacity(), 0.0);
        fits
    }

    /// step ← H⁻¹ g; search ← -step.
    #[cfg_attr(not(feature = "small"), inline(always))]
    fn newton_direction(&mut self, six: &Option<Range<usize>>) {
        match six {
            Some(dofs) => self.newton_direction_of_six(dofs.start),
            None => self.newton_direction_of_many(),
        }
    }

    #[inline(never)]
    fn newton_direction_of_many(&mut self) {
        let (dofs, blocks) = (self.dofs(), self.blocks());
        let (m, d, s) = (self.m, &*self.d, &mut *self.s);
        s.hessian.clear();
        s.hessian.add_mass(m, &d.M, dofs.clone());
        add_curvatures(d, self.jac, &s.jar, blocks, &mut s.hessian);
        for run in dofs.clone() {
            for (&place, &g) in s.hessian.local[run.clone()].iter().zip(&s.grad[run]) {
                s.rhs[place as usize] = g;
            }
        }
        s.hessian.factor();
        s.hessian.solve(&mut s.rhs);
        for run in dofs {
            let (step, search) = (&mut s.step[run.clone()], &mut s.search[run.clone()]);
            for ((step, search), &place) in step.iter_mut().zip(search).zip(&s.hessian.local[run]) {
                let x = s.rhs[place as usize];
                (*step, *search) = (x, -x);
            }
        }
    }

    #[inline(never)]
    fn newton_direction_of_six(&mut self, start: usize) {
        let mut h = Six::new(self.m, &self.d.M, start);
        add_curvatures(self.d, self.jac, &self.s.jar, self.blocks(), &mut h);
        let s = &mut *self.s;
        let vectors = (
            s.grad[start..].first_chunk(),
            s.step[start..].first_chunk_mut(),
            s.search[start..].first_chunk_mut(),
        );
        if let (Some(grad), Some(step), Some(search)) = vectors {
            *step = h.solve(*grad);
            *search = step.map(|x| -x);
        }
    }
}

/// H ← H + Jᵀ C J over blocks, where C is the second derivative of their costs at x = `jar`.
#[cfg_attr(not(feature = "small"), inline(always))]
fn add_curvatures(
    d: &Fields,
    jac: &ConstraintJacobian,
    jar: &[f64],
    blocks: impl Iterator<Item = usize>,
    h: &mut impl HessianAccumulator,
) {
    for b in blocks {
        let b = &jac.blocks[b];
        match (b.cost, b.nrow) {
            (Cost::Unilateral, 1) => add_unilateral::<1>(d, jac, jar, b, h),
            (Cost::Unilateral, 4) => add_unilateral::<4>(d, jac, jar, b, h),
            _ => by_rows!(b.nrow, R => add_curvature::<R>(d, jac, jar, b, h)),
        }
    }
}

/// Adds the second derivative for a block of unilateral rows.
#[cfg_attr(not(feature = "small"), inline(always))]
fn add_unilateral<const R: usize>(
    d: &Fields,
    jac: &ConstraintJacobian,
    jar: &[f64],
    b: &JacobianBlock,
    h: &mut impl HessianAccumulator,
) {
    let (Some(x), Some(stiff)) = (jar[b.rows()].first_chunk::<R>(), d.efc_D[b.rows()].first_chunk::<R>())
    else {
        return;
    };
    if x.iter().any(|&x| x < 0.0) {
        let w: [f64; R] = from_fn(|r| unilateral_curvature(x[r], stiff[r]));
        add(h, jac, b, &|v: &[f64; R]| from_fn(|r| w[r] * v[r]));
    }
}

/// Adds the second derivative for a block of any other kind.
#[inline(never)]
fn add_curvature<const R: usize>(
    d: &Fields,
    jac: &ConstraintJacobian,
    jar: &[f64],
    b: &JacobianBlock,
    h: &mut impl HessianAccumulator,
) {
    let (Some(shape), Some(x)) = (shape::<R>(d, b), jar[b.rows()].first_chunk::<R>()) else { return };
    match shape.curvature(x) {
        Curvature::Flat => {}
        Curvature::Diagonal(w) => add(h, jac, b, &|v: &[f64; R]| from_fn(|r| w[r] * v[r])),
        Curvature::Full(w) => add(h, jac, b, &|v: &[f64; R]| w.map(|w| dot(w, *v))),
    }
}

/// H ← H + Jᵀ W J for a block. `apply_weights` computes W v.
#[cfg_attr(not(feature = "small"), inline(always))]
fn add<const R: usize>(
    h: &mut impl HessianAccumulator,
    jac: &ConstraintJacobian,
    b: &JacobianBlock,
    apply_weights: &dyn Fn(&[f64; R]) -> [f64; R],
) {
    let (columns, v) = (jac.columns(b), jac.values(b));
    if SMALL {
        return add_entries(h, columns, v, &|v, weighted| {
            if let Some(v) = v.first_chunk() {
                weighted.copy_from_slice(&apply_weights(v));
            }
        });
    }
    h.add_weighted_gram::<R>(columns, v.as_chunks().0, apply_weights);
}
