//! Newton's method on the primal problem, island by island.
//!
//! min over a of ½ (a - a₀)ᵀ M (a - a₀) + Σ s(J a - aref), where a₀ is the unconstrained acceleration and
//! s(x) = ½ D x² for x < 0, else 0: a constraint pushes, it never pulls. The cost is convex and piecewise
//! quadratic, so the method ends after finitely many steps (Todorov 2014; Nocedal and Wright 2006, ch. 3).

use super::island::{self, Islands};
use super::jacobian::Block;
use super::search::{Point, minimize};
use crate::math::{MINVAL, dot, dot_slice};
use crate::{Data, Model, disable, mass};
use std::ops::Range;

/// Scratch of the solver; vectors over all degrees of freedom or all rows, of which each island uses its own.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Scratch {
    /// M a.
    ma: Vec<f64>,
    /// Gradient of the cost, and M⁻¹ or H⁻¹ times it.
    grad: Vec<f64>,
    step: Vec<f64>,
    /// Search direction and M times it.
    search: Vec<f64>,
    mv: Vec<f64>,
    /// J a - aref, J search, and D where a row pushes.
    jar: Vec<f64>,
    jv: Vec<f64>,
    weight: Vec<f64>,
    /// Position of each degree of freedom in its island.
    local: Vec<u32>,
    /// Dense Hessian of the island, lower triangle by rows, and a right-hand side.
    hessian: Vec<f64>,
    rhs: Vec<f64>,
}

/// `qacc`, `efc_force`, `qfrc_constraint`, `solver_niter`, from `qacc_smooth` and the rows.
#[inline(never)]
pub(crate) fn solve(m: &Model, d: &mut Data) {
    d.solver_niter = 0;
    d.nisland = 0;
    d.qacc.copy_from_slice(&d.qacc_smooth);
    d.qfrc_constraint.fill(0.0);
    if d.nefc == 0 {
        return;
    }
    island::find(m, d);
    let mut s = std::mem::take(&mut d.work.solver);
    for v in [&mut s.ma, &mut s.grad, &mut s.step, &mut s.search, &mut s.mv] {
        v.resize(m.nv, 0.0);
    }
    for v in [&mut s.jar, &mut s.jv, &mut s.weight] {
        v.resize(d.nefc, 0.0);
    }
    s.local.resize(m.nv, 0);
    warm_start(m, d, &mut s);

    let islands = std::mem::take(&mut d.work.islands);
    for i in 0..d.nisland {
        Problem { m, d, s: &mut s, islands: &islands, island: i }.newton();
    }
    d.work.islands = islands;
    d.work.solver = s;
}

/// Starts from the last step's acceleration or the unconstrained one, whichever costs less. The choice is
/// made once for the whole system; what no constraint touches keeps the unconstrained acceleration.
#[inline(never)]
fn warm_start(m: &Model, d: &mut Data, s: &mut Scratch) {
    let (jac, aref) = (&d.work.jac, &d.efc_aref);
    let residual = |x: &[f64], out: &mut [f64]| -> f64 {
        let mut cost = 0.0;
        jac.mul(x, out);
        for ((x, aref), w) in out.iter_mut().zip(aref).zip(&d.efc_D) {
            *x -= aref;
            let pushed = x.min(0.0);
            cost += 0.5 * w * pushed * pushed;
        }
        cost
    };
    let smooth = residual(&d.qacc_smooth, &mut s.jar);
    s.ma.copy_from_slice(&d.qfrc_smooth);
    if m.opt.disabled(disable::WARMSTART) {
        return;
    }
    let mut warm = residual(&d.qacc_warmstart, &mut s.jv);
    // Gauss cost of the warm start; that of the unconstrained acceleration is zero.
    mass::mul(m, &d.M, &d.qacc_warmstart, &mut s.step, 0..m.nv);
    let forces = s.step.iter().zip(&d.qfrc_smooth);
    let accelerations = d.qacc_warmstart.iter().zip(&d.qacc_smooth);
    for ((ma, f), (a, a0)) in forces.zip(accelerations) {
        warm += 0.5 * (ma - f) * (a - a0);
    }
    if warm > smooth {
        return;
    }
    std::mem::swap(&mut s.jar, &mut s.jv);
    std::mem::swap(&mut s.ma, &mut s.step);
    for i in 0..d.nisland {
        for t in d.work.islands.trees.of(i) {
            let dofs = tree_dofs(m, t);
            d.qacc[dofs.clone()].copy_from_slice(&d.qacc_warmstart[dofs]);
        }
    }
}

#[inline(always)]
fn tree_dofs(m: &Model, tree: usize) -> Range<usize> {
    let first = m.tree_dofadr[tree] as usize;
    first..first + m.tree_dofnum[tree] as usize
}

/// One island: its trees and constraints.
struct Problem<'a> {
    m: &'a Model,
    d: &'a mut Data,
    s: &'a mut Scratch,
    islands: &'a Islands,
    island: usize,
}

impl<'a> Problem<'a> {
    #[inline(never)]
    fn newton(&mut self) {
        let tol = self.m.opt.tolerance;
        let scale = self.scale();
        let (mut cost, mut gradient) = self.update();

        // Already the minimum? The decrease that M⁻¹ promises and the gradient are both small.
        if scale * gradient < tol && scale * self.decrement_by_mass() < tol {
            return;
        }
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

    /// The degrees of freedom of each tree.
    #[inline(always)]
    fn dofs(&self) -> impl Iterator<Item = Range<usize>> + Clone + use<'a> {
        let m = self.m;
        self.islands.trees.of(self.island).map(move |t| tree_dofs(m, t))
    }

    /// The constraints, by their place in the Jacobian's blocks.
    #[inline(always)]
    fn blocks(&self) -> impl Iterator<Item = usize> + Clone + use<'a> {
        self.islands.blocks.of(self.island)
    }

    /// Makes costs and gradients comparable between scenes of any mass.
    fn scale(&self) -> f64 {
        let m = self.m;
        if m.opt.disabled(disable::ISLAND) {
            return 1.0 / (m.stat.meaninertia * m.nv.max(1) as f64).max(MINVAL);
        }
        let mut sum = 0.0;
        for k in self.dofs().flatten() {
            sum += self.d.M[(m.M_rowadr[k] + m.M_rownnz[k] - 1) as usize];
        }
        1.0 / sum.max(MINVAL)
    }

    /// Forces and gradient at the current acceleration; returns the cost and the norm of the gradient.
    fn update(&mut self) -> (f64, f64) {
        let mut cost = 0.0;
        for dofs in self.dofs() {
            self.d.qfrc_constraint[dofs].fill(0.0);
        }
        for b in self.blocks() {
            let b = self.d.work.jac.blocks[b];
            cost += match b.nrow {
                1 => self.push_block::<1>(&b),
                _ => self.push_block::<4>(&b),
            };
        }
        let mut square = 0.0;
        for dofs in self.dofs() {
            let (d, s) = (&*self.d, &mut *self.s);
            let ma = s.ma[dofs.clone()].iter().zip(&d.qfrc_smooth[dofs.clone()]);
            let a = d.qacc[dofs.clone()].iter().zip(&d.qacc_smooth[dofs.clone()]);
            let grad = s.grad[dofs.clone()].iter_mut().zip(&d.qfrc_constraint[dofs]);
            for (((ma, smooth), (a, a0)), (g, constraint)) in ma.zip(a).zip(grad) {
                let residual = ma - smooth;
                cost += 0.5 * residual * (a - a0);
                *g = residual - constraint;
                square += *g * *g;
            }
        }
        (cost, square.sqrt())
    }

    /// Forces of one constraint; returns its cost.
    #[inline(always)]
    fn push_block<const R: usize>(&mut self, b: &Block) -> f64 {
        let (d, s) = (&mut *self.d, &*self.s);
        let rows = b.rows();
        let (Some(x), Some(w)) = (s.jar[rows.clone()].first_chunk::<R>(), d.efc_D[rows.clone()].first_chunk::<R>()) else {
            return 0.0;
        };
        let pushed: [f64; R] = std::array::from_fn(|r| if x[r] < 0.0 { x[r] } else { 0.0 });
        let force: [f64; R] = std::array::from_fn(|r| -w[r] * pushed[r]);
        d.efc_force[rows].copy_from_slice(&force);
        d.work.jac.add_transposed(b, &force, &mut d.qfrc_constraint);
        -0.5 * dot(force, pushed)
    }

    /// ½ gᵀ M⁻¹ g.
    fn decrement_by_mass(&mut self) -> f64 {
        for dofs in self.dofs() {
            self.s.step[dofs.clone()].copy_from_slice(&self.s.grad[dofs.clone()]);
            mass::solve(self.m, &self.d.qLD, &self.d.qLDiagInv, &mut self.s.step, dofs);
        }
        self.decrement()
    }

    /// ½ gᵀ step.
    fn decrement(&self) -> f64 {
        0.5 * self.dofs().map(|r| dot_slice(&self.s.grad[r.clone()], &self.s.step[r])).sum::<f64>()
    }

    fn number_dofs(&mut self) {
        let mut n = 0;
        for k in self.dofs().flatten() {
            self.s.local[k] = n;
            n += 1;
        }
    }

    /// step ← H⁻¹ g with H = M + Jᵀ D J over the rows that push; search ← -step.
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
            let b = &d.work.jac.blocks[b];
            for r in b.rows() {
                s.weight[r] = if s.jar[r] < 0.0 { d.efc_D[r] } else { 0.0 };
            }
            if s.weight[b.rows()].iter().any(|&w| w > 0.0) {
                d.work.jac.add_gram(b, &s.weight, &s.local, &mut s.hessian, n);
            }
        }
        cholesky(&mut s.hessian, n);
        cholesky_solve(&s.hessian, n, &mut s.rhs);
        for (k, &x) in dofs.flatten().zip(&s.rhs) {
            s.step[k] = x;
            s.search[k] = -x;
        }
    }

    /// The best step along `search`.
    fn line_search(&mut self, scale: f64) -> f64 {
        let (dofs, blocks) = (self.dofs(), self.blocks());
        let (m, d, s) = (self.m, &*self.d, &mut *self.s);
        let (mut length, mut linear, mut quadratic) = (0.0, 0.0, 0.0);
        for dofs in dofs {
            mass::mul(m, &d.M, &s.search, &mut s.mv, dofs.clone());
            for k in dofs {
                length += s.search[k] * s.search[k];
                linear += s.search[k] * (s.ma[k] - d.qfrc_smooth[k]);
                quadratic += 0.5 * s.search[k] * s.mv[k];
            }
        }
        let length = length.sqrt();
        if length < MINVAL {
            return 0.0;
        }
        for b in blocks.clone() {
            d.work.jac.mul_block(&d.work.jac.blocks[b], &s.search, &mut s.jv);
        }
        let gtol = m.opt.tolerance * m.opt.ls_tolerance * length / scale;
        minimize(gtol, m.opt.ls_iterations.max(0) as usize, |alpha| {
            let mut p = Point {
                alpha,
                cost: alpha * (linear + alpha * quadratic),
                slope: linear + 2.0 * alpha * quadratic,
                curvature: 2.0 * quadratic,
            };
            for r in blocks.clone().flat_map(|b| d.work.jac.blocks[b].rows()) {
                let (start, v, w) = (s.jar[r], s.jv[r], d.efc_D[r]);
                let now = start + alpha * v;
                if now < 0.0 {
                    p.slope += w * now * v;
                    p.curvature += w * v * v;
                }
                // The difference of squares, without squaring first: near the minimum it is all rounding.
                let (before, after) = (start.min(0.0), now.min(0.0));
                let change = if before < 0.0 && after < 0.0 { alpha * v } else { after - before };
                p.cost += 0.5 * w * change * (after + before);
            }
            p
        })
    }

    /// a ← a + α search.
    fn advance(&mut self, alpha: f64) {
        let (dofs, blocks) = (self.dofs(), self.blocks());
        let (d, s) = (&mut *self.d, &mut *self.s);
        for k in dofs.flatten() {
            d.qacc[k] += alpha * s.search[k];
            s.ma[k] += alpha * s.mv[k];
        }
        for r in blocks.flat_map(|b| d.work.jac.blocks[b].rows()) {
            s.jar[r] += alpha * s.jv[r];
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
