//! Newton's method on the primal problem, island by island.
//!
//! min over a of ½ (a - a₀)ᵀ M (a - a₀) + Σ s(J a - aref), where a₀ is the unconstrained acceleration and
//! s(x) = ½ D x² for x < 0, else 0: a constraint pushes, it never pulls. The cost is convex and piecewise
//! quadratic, so the method ends after finitely many steps (Todorov 2014; Nocedal and Wright 2006, ch. 3).

use super::island::Islands;
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
    /// Where each island stands after the warm start.
    reached: Vec<Reached>,
}

/// Where an island stands.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Reached {
    cost: f64,
    /// Norm of the gradient.
    gradient: f64,
    /// Certified to be the minimum.
    minimum: bool,
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
    let mut islands = d.work.islands.take().unwrap_or_default();
    d.nisland = islands.find(m, &d.work.jac);
    let mut s = d.work.solver.take().unwrap_or_default();
    s.resize(m.nv, d.nefc);
    let done = !m.opt.disabled(disable::WARMSTART) && warm_start(m, d, &mut s, &islands);
    if !done {
        d.qacc.copy_from_slice(&d.qacc_smooth);
        s.ma.copy_from_slice(&d.qfrc_smooth);
        d.work.jac.residual(&d.qacc_smooth, &d.efc_aref, &mut s.jar);
        for i in 0..d.nisland {
            let mut problem = Problem { m, d, s: &mut s, islands: &islands, island: i };
            let from = problem.reached();
            problem.newton(from);
        }
    }
    d.work.islands = Some(islands);
    d.work.solver = Some(s);
}

/// `efc_force` and `qfrc_constraint` at the acceleration `qacc` (`mj_invConstraint`).
pub(crate) fn inverse(m: &Model, d: &mut Data) {
    d.qfrc_constraint.fill(0.0);
    if d.nefc == 0 {
        return;
    }
    let mut islands = d.work.islands.take().unwrap_or_default();
    d.nisland = islands.find(m, &d.work.jac);
    let mut s = d.work.solver.take().unwrap_or_default();
    s.resize(m.nv, d.nefc);
    s.ma.fill(0.0);
    d.work.jac.residual(&d.qacc, &d.efc_aref, &mut s.jar);
    for island in 0..d.nisland {
        Problem { m, d, s: &mut s, islands: &islands, island }.update();
    }
    d.work.islands = Some(islands);
    d.work.solver = Some(s);
}

impl Scratch {
    fn resize(&mut self, nv: usize, nefc: usize) {
        if self.ma.len() != nv {
            for v in [&mut self.ma, &mut self.grad, &mut self.step, &mut self.search, &mut self.mv] {
                v.resize(nv, 0.0);
            }
            self.local.resize(nv, 0);
        }
        if self.jar.len() != nefc {
            for v in [&mut self.jar, &mut self.jv, &mut self.weight] {
                v.resize(nefc, 0.0);
            }
        }
    }
}

/// Starts from the last step's acceleration, and goes on from there unless the unconstrained one costs less.
/// `true` when the problem is solved: at rest the last acceleration is still the answer, and the other one need
/// not be looked at.
///
/// The choice is made once for the whole system; what no constraint touches keeps the unconstrained
/// acceleration.
#[inline(never)]
fn warm_start(m: &Model, d: &mut Data, s: &mut Scratch, islands: &Islands) -> bool {
    d.work.jac.residual(&d.qacc_warmstart, &d.efc_aref, &mut s.jar);
    mass::mul(m, &d.M, &d.qacc_warmstart, &mut s.ma, 0..m.nv);
    let mut reached = std::mem::take(&mut s.reached);
    reached.clear();
    for island in 0..d.nisland {
        for t in islands.trees.of(island) {
            let dofs = tree_dofs(m, t);
            d.qacc[dofs.clone()].copy_from_slice(&d.qacc_warmstart[dofs]);
        }
        reached.push(Problem { m, d, s, islands, island }.reached());
    }
    let mut done = reached.iter().all(|r| r.minimum);
    if !done {
        d.work.jac.residual(&d.qacc_smooth, &d.efc_aref, &mut s.jv);
        // The unconstrained acceleration has no Gauss cost; the last one has it everywhere.
        let gauss = |k: usize| 0.5 * (s.ma[k] - d.qfrc_smooth[k]) * (d.qacc_warmstart[k] - d.qacc_smooth[k]);
        let warm = push_cost(&s.jar, &d.efc_D) + (0..m.nv).map(gauss).sum::<f64>();
        if warm <= push_cost(&s.jv, &d.efc_D) {
            for (island, &from) in reached.iter().enumerate() {
                Problem { m, d, s, islands, island }.newton(from);
            }
            done = true;
        }
    }
    s.reached = reached;
    done
}

/// Cost of all rows.
fn push_cost(jar: &[f64], weight: &[f64]) -> f64 {
    jar.iter().zip(weight).map(|(&x, &w)| if x < 0.0 { 0.5 * w * x * x } else { 0.0 }).sum()
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
    /// Forces, cost and gradient at the current acceleration, and whether it is already the minimum: the
    /// decrease that M⁻¹ promises and the gradient are both small.
    fn reached(&mut self) -> Reached {
        let (tol, scale) = (self.m.opt.tolerance, self.scale());
        let (cost, gradient) = self.update();
        let minimum = scale * gradient < tol && scale * self.decrement_by_mass() < tol;
        Reached { cost, gradient, minimum }
    }

    #[inline(never)]
    fn newton(&mut self, from: Reached) {
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
        let sum: f64 = self.dofs().map(|dofs| mass::trace(m, &self.d.M, dofs)).sum();
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
        let (Some(x), Some(w)) =
            (s.jar[rows.clone()].first_chunk::<R>(), d.efc_D[rows.clone()].first_chunk::<R>())
        else {
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
        for (i, k) in self.dofs().flatten().enumerate() {
            self.s.local[k] = i as u32;
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
        for k in dofs {
            for ((a, ma), (step, mstep)) in d.qacc[k.clone()]
                .iter_mut()
                .zip(&mut s.ma[k.clone()])
                .zip(s.search[k.clone()].iter().zip(&s.mv[k]))
            {
                *a += alpha * step;
                *ma += alpha * mstep;
            }
        }
        for b in blocks {
            let rows = d.work.jac.blocks[b].rows();
            for (x, v) in s.jar[rows.clone()].iter_mut().zip(&s.jv[rows]) {
                *x += alpha * v;
            }
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
