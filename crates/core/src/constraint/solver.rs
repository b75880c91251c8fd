//! Newton's method on the primal problem, island by island.
//!
//! min over a of ½ (a - a₀)ᵀ M (a - a₀) + Σ s(J a - aref), where a₀ is the unconstrained acceleration and
//! s(x) = ½ D x² for x < 0, else 0: a constraint pushes, it never pulls. The cost is convex and piecewise
//! quadratic, so the method ends after finitely many steps (Todorov 2014; Nocedal and Wright 2006, ch. 3).

use super::island;
use super::jacobian::Block;
use super::search::{Point, minimize};
use crate::math::{MINVAL, dot_slice};
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
        let trees = &islands.trees[islands.tree_start[i] as usize..islands.tree_start[i + 1] as usize];
        let blocks = &islands.blocks[islands.block_start[i] as usize..islands.block_start[i + 1] as usize];
        Problem { m, d, s: &mut s, trees, blocks }.newton();
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
        for b in &jac.blocks {
            jac.mul(b, x, out);
        }
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
    for k in 0..m.nv {
        warm += 0.5 * (s.step[k] - d.qfrc_smooth[k]) * (d.qacc_warmstart[k] - d.qacc_smooth[k]);
    }
    if warm > smooth {
        return;
    }
    std::mem::swap(&mut s.jar, &mut s.jv);
    std::mem::swap(&mut s.ma, &mut s.step);
    let islands = &d.work.islands;
    for &t in &islands.trees[..islands.tree_start[d.nisland] as usize] {
        let dofs = tree_dofs(m, t);
        d.qacc[dofs.clone()].copy_from_slice(&d.qacc_warmstart[dofs]);
    }
}

#[inline(always)]
fn tree_dofs(m: &Model, tree: u32) -> Range<usize> {
    let first = m.tree_dofadr[tree as usize] as usize;
    first..first + m.tree_dofnum[tree as usize] as usize
}

/// One island: its trees and constraints.
struct Problem<'a> {
    m: &'a Model,
    d: &'a mut Data,
    s: &'a mut Scratch,
    trees: &'a [u32],
    blocks: &'a [u32],
}

impl Problem<'_> {
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

    #[inline(always)]
    fn dofs(&self) -> impl Iterator<Item = Range<usize>> + use<'_> {
        self.trees.iter().map(|&t| tree_dofs(self.m, t))
    }

    #[inline(always)]
    fn block(&self, b: u32) -> Block {
        self.d.work.jac.blocks[b as usize]
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
        for &t in self.trees {
            self.d.qfrc_constraint[tree_dofs(self.m, t)].fill(0.0);
        }
        for &b in self.blocks {
            let b = self.block(b);
            let (d, s) = (&mut *self.d, &mut *self.s);
            let rows = b.rows();
            let each = s.jar[rows.clone()].iter().zip(&d.efc_D[rows.clone()]);
            let out = d.efc_force[rows.clone()].iter_mut().zip(&mut s.weight[rows]);
            for ((&x, &w), (force, weight)) in each.zip(out) {
                *weight = if x < 0.0 { w } else { 0.0 };
                *force = if x < 0.0 { -w * x } else { 0.0 };
                cost -= 0.5 * *force * x;
            }
            d.work.jac.add_transposed(&b, &d.efc_force, &mut d.qfrc_constraint);
        }
        let mut square = 0.0;
        for &t in self.trees {
            for k in tree_dofs(self.m, t) {
                let (d, s) = (&*self.d, &mut *self.s);
                let residual = s.ma[k] - d.qfrc_smooth[k];
                cost += 0.5 * residual * (d.qacc[k] - d.qacc_smooth[k]);
                let g = residual - d.qfrc_constraint[k];
                square += g * g;
                s.grad[k] = g;
            }
        }
        (cost, square.sqrt())
    }

    /// ½ gᵀ M⁻¹ g.
    fn decrement_by_mass(&mut self) -> f64 {
        for &t in self.trees {
            let dofs = tree_dofs(self.m, t);
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
        for &t in self.trees {
            for k in tree_dofs(self.m, t) {
                self.s.local[k] = n;
                n += 1;
            }
        }
    }

    /// step ← H⁻¹ g with H = M + Jᵀ D J over the rows that push; search ← -step.
    fn newton_direction(&mut self) {
        let (m, d, s) = (self.m, &*self.d, &mut *self.s);
        let n = self.trees.iter().map(|&t| m.tree_dofnum[t as usize] as usize).sum();
        s.hessian.clear();
        s.hessian.resize(n * n, 0.0);
        s.rhs.clear();
        for &t in self.trees {
            for k in tree_dofs(m, t) {
                let row = s.local[k] as usize * n;
                for a in m.M_rowadr[k] as usize..(m.M_rowadr[k] + m.M_rownnz[k]) as usize {
                    s.hessian[row + s.local[m.M_colind[a] as usize] as usize] = d.M[a];
                }
                s.rhs.push(s.grad[k]);
            }
        }
        for &b in self.blocks {
            let b = d.work.jac.blocks[b as usize];
            if s.weight[b.rows()].iter().any(|&w| w > 0.0) {
                d.work.jac.add_gram(&b, &s.weight, &s.local, &mut s.hessian, n);
            }
        }
        cholesky(&mut s.hessian, n);
        cholesky_solve(&s.hessian, n, &mut s.rhs);
        let mut i = 0;
        for &t in self.trees {
            for k in tree_dofs(m, t) {
                s.step[k] = s.rhs[i];
                s.search[k] = -s.rhs[i];
                i += 1;
            }
        }
    }

    /// The best step along `search`.
    fn line_search(&mut self, scale: f64) -> f64 {
        let (m, d, s) = (self.m, &*self.d, &mut *self.s);
        let (mut length, mut linear, mut quadratic) = (0.0, 0.0, 0.0);
        for &t in self.trees {
            mass::mul(m, &d.M, &s.search, &mut s.mv, tree_dofs(m, t));
            for k in tree_dofs(m, t) {
                length += s.search[k] * s.search[k];
                linear += s.search[k] * (s.ma[k] - d.qfrc_smooth[k]);
                quadratic += 0.5 * s.search[k] * s.mv[k];
            }
        }
        let length = length.sqrt();
        if length < MINVAL {
            return 0.0;
        }
        for &b in self.blocks {
            let b = &d.work.jac.blocks[b as usize];
            d.work.jac.mul(b, &s.search, &mut s.jv);
        }
        let gtol = m.opt.tolerance * m.opt.ls_tolerance * length / scale;
        let rows = |b: &u32| d.work.jac.blocks[*b as usize].rows();
        minimize(gtol, m.opt.ls_iterations.max(0) as usize, |alpha| {
            let mut p = Point {
                alpha,
                cost: alpha * (linear + alpha * quadratic),
                slope: linear + 2.0 * alpha * quadratic,
                curvature: 2.0 * quadratic,
            };
            for r in self.blocks.iter().flat_map(rows) {
                let (start, v, w) = (s.jar[r], s.jv[r], d.efc_D[r]);
                let (before, now) = (start.min(0.0), (start + alpha * v).min(0.0));
                p.cost += 0.5 * w * (now * now - before * before);
                p.slope += w * now * v;
                p.curvature += if now < 0.0 { w * v * v } else { 0.0 };
            }
            p.curvature = p.curvature.max(MINVAL);
            p
        })
    }

    /// a ← a + α search.
    fn advance(&mut self, alpha: f64) {
        let (d, s) = (&mut *self.d, &mut *self.s);
        for &t in self.trees {
            for k in tree_dofs(self.m, t) {
                d.qacc[k] += alpha * s.search[k];
                s.ma[k] += alpha * s.mv[k];
            }
        }
        for &b in self.blocks {
            for r in d.work.jac.blocks[b as usize].rows() {
                s.jar[r] += alpha * s.jv[r];
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
