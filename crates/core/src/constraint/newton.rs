//! Newton's method: the direction -H⁻¹ g with H = M + Jᵀ C J, where C is the second derivative of the costs.
//!
//! The cost is convex and, but for elliptic cones, piecewise quadratic, so the method ends after finitely many steps
//! (Nocedal and Wright 2006, ch. 3).

use super::cost::{Cost, Curvature};
use super::jacobian::{Block, by_rows};
use super::primal::{Problem, Reached, shape};
use crate::math::{MINVAL, dot_slice};

impl Problem<'_> {
    #[inline(never)]
    pub(super) fn newton(&mut self, from: Reached) {
        if from.minimum {
            return;
        }
        let (tol, scale) = (self.m.opt.tolerance, self.scale());
        let Reached { mut cost, mut gradient, .. } = from;
        self.number_dofs();
        self.newton_direction();
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
            self.newton_direction();
            if scale * self.decrement() < tol {
                break;
            }
        }
    }

    fn number_dofs(&mut self) {
        for (i, k) in self.dofs().flatten().enumerate() {
            self.s.local[k] = i as u32;
        }
    }

    /// step ← H⁻¹ g; search ← -step.
    fn newton_direction(&mut self) {
        let (dofs, blocks) = (self.dofs(), self.blocks());
        let (m, d, s) = (self.m, &*self.d, &mut *self.s);
        let n = dofs.clone().map(|r| r.len()).sum();
        s.hessian.clear();
        s.hessian.resize(n * n, 0.0);
        s.rhs.clear();
        for k in dofs.clone().flatten() {
            let row = s.local[k] as usize * n;
            for a in m.M_rowadr[k] as usize..(m.M_rowadr[k] + m.M_rownnz[k]) as usize {
                s.hessian[row + s.local[m.M_colind[a] as usize] as usize] = d.M[a];
            }
            s.rhs.push(s.grad[k]);
        }
        for b in blocks {
            let b = self.d.work.jac.blocks[b];
            if b.cost == Cost::Push {
                self.add_push(&b, n);
            } else {
                by_rows!(b.nrow, R => self.add_curvature::<R>(&b, n));
            }
        }
        let s = &mut *self.s;
        cholesky(&mut s.hessian, n);
        cholesky_solve(&s.hessian, n, &mut s.rhs);
        for (k, &x) in dofs.flatten().zip(&s.rhs) {
            s.step[k] = x;
            s.search[k] = -x;
        }
    }

    /// Adds the rows that push to the Hessian of n rows.
    #[inline(always)]
    fn add_push(&mut self, b: &Block, n: usize) {
        let (d, s) = (&*self.d, &mut *self.s);
        for r in b.rows() {
            s.weight[r] = if s.jar[r] < 0.0 { d.efc_D[r] } else { 0.0 };
        }
        if s.weight[b.rows()].iter().any(|&w| w > 0.0) {
            d.work.jac.add_gram(b, &s.weight, &s.local, &mut s.hessian, n);
        }
    }

    /// Adds a constraint of any other kind.
    #[inline(never)]
    fn add_curvature<const R: usize>(&mut self, b: &Block, n: usize) {
        let (d, s) = (&*self.d, &mut *self.s);
        let (Some(shape), Some(x)) = (shape::<R>(d, b), s.jar[b.rows()].first_chunk::<R>()) else { return };
        match shape.curvature(x) {
            Curvature::Flat => {}
            Curvature::Diagonal(w) => {
                s.weight[b.rows()].copy_from_slice(&w);
                d.work.jac.add_gram(b, &s.weight, &s.local, &mut s.hessian, n);
            }
            Curvature::Full(w) => d.work.jac.add_gram_full(b, &w, &s.local, &mut s.hessian, n),
        }
    }
}

/// H = L Lᵀ in place, lower triangle by rows.
fn cholesky(h: &mut [f64], n: usize) {
    for i in 0..n {
        let (above, row) = h.split_at_mut(i * n);
        let row = &mut row[..=i];
        for j in 0..i {
            let lj = &above[j * n..j * n + j + 1];
            row[j] = (row[j] - dot_slice(&row[..j], &lj[..j])) / lj[j];
        }
        let (off, diag) = row.split_at_mut(i);
        diag[0] = (diag[0] - dot_slice(off, off)).max(MINVAL).sqrt();
    }
}

/// x ← H⁻¹ x.
fn cholesky_solve(l: &[f64], n: usize, x: &mut [f64]) {
    for i in 0..n {
        x[i] = (x[i] - dot_slice(&l[i * n..i * n + i], &x[..i])) / l[i * n + i];
    }
    for i in (0..n).rev() {
        let xi = x[i] / l[i * n + i];
        x[i] = xi;
        for j in 0..i {
            x[j] -= l[i * n + j] * xi;
        }
    }
}
