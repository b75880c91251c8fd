//! Newton's method: the direction -H⁻¹ g with H = M + Jᵀ C J, where C is the second derivative of the costs.
//!
//! The cost is convex and, but for elliptic cones, piecewise quadratic, so the method ends after finitely many steps
//! (Nocedal and Wright 2006, ch. 3).

use super::cost::{Cost, Curvature};
use super::jacobian::{Block, by_rows};
use super::primal::{Problem, Reached, shape};
use super::six::{self, Six};
use crate::mass;
use crate::math::dot;
use std::array::from_fn;
use std::ops::Range;

impl Problem<'_> {
    #[inline(never)]
    pub(super) fn newton(&mut self, from: Reached) {
        if from.minimum {
            return;
        }
        let tol = self.m.opt.tolerance;
        let Reached { mut cost, mut gradient, scale, .. } = from;
        let six = self.islands.one_run(self.island).filter(|dofs| dofs.len() == six::N);
        if six.is_none() && !self.lay_out() {
            return self.conjugate_gradient(from);
        }
        self.newton_direction(&six);
        if scale * gradient < tol && scale * self.decrement() < tol {
            return;
        }
        for _ in 0..self.m.opt.iterations.max(0) {
            let alpha = self.line_search(scale);
            if alpha == 0.0 {
                break;
            }
            self.advance(alpha);
            self.d.solver_niter += 1;
            let before = cost;
            (cost, gradient) = self.update();
            let improvement = scale * (before - cost);
            if (improvement > 0.0 && improvement < tol) || scale * gradient < tol {
                break;
            }
            self.newton_direction(&six);
            if scale * self.decrement() < tol {
                break;
            }
        }
    }

    /// Whether the Hessian of the island is worth its room.
    fn lay_out(&mut self) -> bool {
        let s = &mut *self.s;
        let fits = s.hessian.lay_out(self.m, &self.d.work.jac, self.islands, self.island);
        s.rhs.clear();
        s.rhs.resize(s.hessian.room(), 0.0);
        fits
    }

    /// step ← H⁻¹ g; search ← -step.
    #[inline(always)]
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
        for k in dofs.clone().flatten() {
            let row = mass::row(m, k);
            let columns = m.M_colind[row.clone()].iter().map(|&j| j as usize);
            s.hessian.add(k, columns.zip(d.M[row].iter().copied()));
            s.rhs[s.hessian.local[k] as usize] = s.grad[k];
        }
        for b in blocks {
            let b = self.d.work.jac.blocks[b];
            if b.cost == Cost::Push {
                self.add_push(&b);
            } else {
                by_rows!(b.nrow, R => self.add_curvature::<R>(&b));
            }
        }
        let s = &mut *self.s;
        s.hessian.factor();
        s.hessian.solve(&mut s.rhs);
        for k in dofs.flatten() {
            let x = s.rhs[s.hessian.local[k] as usize];
            (s.step[k], s.search[k]) = (x, -x);
        }
    }

    #[inline(never)]
    fn newton_direction_of_six(&mut self, start: usize) {
        let mut h = Six::new(self.m, &self.d.M, start);
        for b in self.blocks() {
            let b = self.d.work.jac.blocks[b];
            match (b.cost, b.nrow) {
                (Cost::Push, 4) => self.add_push_to_six::<4>(&b, &mut h),
                _ => by_rows!(b.nrow, R => self.add_curvature_to_six::<R>(&b, &mut h)),
            }
        }
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

    #[inline(always)]
    fn add_push_to_six<const R: usize>(&self, b: &Block, h: &mut Six) {
        let (x, stiff) = (&self.s.jar[b.rows()], &self.d.efc_D[b.rows()]);
        let (Some(x), Some(stiff)) = (x.first_chunk::<R>(), stiff.first_chunk::<R>()) else { return };
        let w: [f64; R] = from_fn(|r| if x[r] < 0.0 { stiff[r] } else { 0.0 });
        h.add_gram::<R>(&self.d.work.jac, b, |v| from_fn(|r| w[r] * v[r]));
    }

    #[inline(never)]
    fn add_curvature_to_six<const R: usize>(&self, b: &Block, h: &mut Six) {
        let (Some(shape), Some(x)) = (shape::<R>(self.d, b), self.s.jar[b.rows()].first_chunk::<R>()) else {
            return;
        };
        match shape.curvature(x) {
            Curvature::Flat => {}
            Curvature::Diagonal(w) => h.add_gram::<R>(&self.d.work.jac, b, |v| from_fn(|r| w[r] * v[r])),
            Curvature::Full(w) => h.add_gram::<R>(&self.d.work.jac, b, |v| w.map(|w| dot(w, *v))),
        }
    }

    /// Adds the rows that push to the Hessian.
    #[inline(always)]
    fn add_push(&mut self, b: &Block) {
        let (d, s) = (&*self.d, &mut *self.s);
        for r in b.rows() {
            s.weight[r] = if s.jar[r] < 0.0 { d.efc_D[r] } else { 0.0 };
        }
        if s.weight[b.rows()].iter().any(|&w| w > 0.0) {
            d.work.jac.add_gram(b, &s.weight, &mut s.hessian);
        }
    }

    /// Adds a constraint of any other kind.
    #[inline(never)]
    fn add_curvature<const R: usize>(&mut self, b: &Block) {
        let (d, s) = (&*self.d, &mut *self.s);
        let (Some(shape), Some(x)) = (shape::<R>(d, b), s.jar[b.rows()].first_chunk::<R>()) else { return };
        match shape.curvature(x) {
            Curvature::Flat => {}
            Curvature::Diagonal(w) => {
                s.weight[b.rows()].copy_from_slice(&w);
                d.work.jac.add_gram(b, &s.weight, &mut s.hessian);
            }
            Curvature::Full(w) => d.work.jac.add_gram_full(b, &w, &mut s.hessian),
        }
    }
}
