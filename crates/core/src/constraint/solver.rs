//! The constraint solver: where it starts, and which method goes on from there, island by island.
//!
//! min over a of ½ (a - a₀)ᵀ M (a - a₀) + Σ s(J a - aref), where a₀ is the unconstrained acceleration and s what it
//! costs to miss the reference (Todorov 2014).

use super::cost::Cost;
use super::dual::Dual;
use super::hessian::Hessian;
use super::island::Islands;
use super::jacobian::{Block, by_rows};
use super::primal::{Problem, Reached, shape};
use crate::dynamics::mass;
use crate::math::{copy, zero};
use crate::{Data, Model, disable, solver};
use std::ops::Range;

/// Scratch of the solver; vectors over all degrees of freedom or all rows, of which each island uses its own.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Scratch {
    /// M a.
    pub(super) ma: Vec<f64>,
    /// Gradient of the cost, and M⁻¹ or H⁻¹ times it.
    pub(super) grad: Vec<f64>,
    pub(super) step: Vec<f64>,
    /// The same before the last step.
    pub(super) grad_old: Vec<f64>,
    pub(super) step_old: Vec<f64>,
    /// Search direction and M times it.
    pub(super) search: Vec<f64>,
    pub(super) mv: Vec<f64>,
    /// J a - aref, and J search.
    pub(super) jar: Vec<f64>,
    pub(super) jv: Vec<f64>,
    /// Hessian of an island, and a right-hand side.
    pub(super) hessian: Hessian,
    pub(super) rhs: Vec<f64>,
    /// What the dual methods keep.
    pub(super) dual: Dual,
    /// Where each island stands after the warm start.
    pub(super) reached: Vec<Reached>,
}

/// `qacc`, `efc_force`, `qfrc_constraint`, `solver_niter`, from `qacc_smooth` and the rows.
#[inline(never)]
pub(crate) fn solve(m: &Model, d: &mut Data) {
    d.solver_niter = 0;
    d.nisland = 0;
    copy(&d.qacc_smooth, &mut d.qacc);
    zero(&mut d.qfrc_constraint);
    if d.nefc == 0 {
        return;
    }
    let [_, columns, values] = d.work.jac.size();
    d.work.meter.add(8 * (columns + values) + 40 * d.nefc as u64);
    let dual = m.opt.solver == solver::PGS || m.opt.noslip_iterations > 0;
    if dual {
        // Each row is solved with M over its trees.
        d.work.meter.add(d.nefc as u64 * 2 * m.nC as u64 / m.ntree.max(1) as u64);
    }
    if d.work.meter.over() {
        return;
    }
    let mut islands = d.work.islands.take().unwrap_or_default();
    d.nisland = islands.find(m, &d.work.jac);
    let mut s = d.work.solver.take().unwrap_or_default();
    s.resize(m.nv, d.nefc);
    if dual {
        unconstrained_residual(d);
        s.dual.build(m, d);
    }
    if m.opt.solver == solver::PGS {
        dual_start(m, d, &mut s, &islands);
    } else {
        primal(m, d, &mut s, &islands);
    }
    if dual {
        for island in 0..d.nisland {
            let mut problem = Problem { m, d, s: &mut s, islands: &islands, island };
            if m.opt.solver == solver::PGS {
                problem.gauss_seidel();
            }
            if m.opt.noslip_iterations > 0 {
                problem.remove_slip();
            }
            problem.finish_dual();
        }
    }
    if d.plan.solver_details {
        details(d, &s.jar);
    }
    d.work.islands = Some(islands);
    d.work.solver = Some(s);
}

/// Newton's method or conjugate gradients, from the better start.
#[inline(always)]
fn primal(m: &Model, d: &mut Data, s: &mut Scratch, islands: &Islands) {
    if !m.opt.disabled(disable::WARMSTART) && warm_start(m, d, s, islands) {
        return;
    }
    copy(&d.qacc_smooth, &mut d.qacc);
    zero(&mut d.qfrc_constraint);
    copy(&d.qfrc_smooth, &mut s.ma);
    d.work.jac.residual(&d.qacc_smooth, &d.efc_aref, &mut s.jar);
    for island in 0..d.nisland {
        let mut problem = Problem { m, d, s, islands, island };
        let from = problem.reached();
        problem.run(from);
    }
}

/// The forces that the dual method starts from: those at the last step's acceleration, unless none cost less.
fn dual_start(m: &Model, d: &mut Data, s: &mut Scratch, islands: &Islands) {
    d.efc_force.fill(0.0);
    if m.opt.disabled(disable::WARMSTART) {
        return;
    }
    d.work.jac.residual(&d.qacc_warmstart, &d.efc_aref, &mut s.jar);
    let mut cost = 0.0;
    for island in 0..d.nisland {
        let mut problem = Problem { m, d, s, islands, island };
        problem.update();
        cost += problem.dual_cost();
    }
    if cost > 0.0 {
        d.efc_force.fill(0.0);
    }
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
            let old = [&mut self.grad_old, &mut self.step_old];
            let now = [&mut self.ma, &mut self.grad, &mut self.step, &mut self.search, &mut self.mv];
            for v in now.into_iter().chain(old) {
                v.resize(nv, 0.0);
            }
        }
        if self.jar.len() != nefc {
            for v in [&mut self.jar, &mut self.jv] {
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
        for dofs in islands.dofs(island) {
            copy(&d.qacc_warmstart[dofs.clone()], &mut d.qacc[dofs]);
        }
        reached.push(Problem { m, d, s, islands, island }.reached());
    }
    let mut done = reached.iter().all(|r| r.minimum);
    if !done {
        d.work.jac.residual(&d.qacc_smooth, &d.efc_aref, &mut s.jv);
        // The unconstrained acceleration has no Gauss cost; the last one has it everywhere.
        let gauss = |k: usize| 0.5 * (s.ma[k] - d.qfrc_smooth[k]) * (d.qacc_warmstart[k] - d.qacc_smooth[k]);
        let warm = total_cost(d, &s.jar) + (0..m.nv).map(gauss).sum::<f64>();
        if warm <= total_cost(d, &s.jv) {
            for (island, &from) in reached.iter().enumerate() {
                Problem { m, d, s, islands, island }.run(from);
            }
            done = true;
        }
    }
    s.reached = reached;
    done
}

/// Cost of all constraints at x = J a - aref.
fn total_cost(d: &Data, x: &[f64]) -> f64 {
    let push = |x: f64, w: f64| if x < 0.0 { 0.5 * w * x * x } else { 0.0 };
    let cost = |b: &Block| match b.cost {
        Cost::Push => b.rows().map(|r| push(x[r], d.efc_D[r])).sum(),
        _ => by_rows!(b.nrow, R => block_cost::<R>(d, b, x)),
    };
    d.work.jac.blocks.iter().map(cost).sum()
}

fn block_cost<const R: usize>(d: &Data, b: &Block, x: &[f64]) -> f64 {
    match (shape::<R>(d, b), x[b.rows()].first_chunk::<R>()) {
        (Some(shape), Some(x)) => shape.value(x).0,
        _ => 0.0,
    }
}

/// `efc_b`.
pub(crate) fn unconstrained_residual(d: &mut Data) {
    d.work.jac.residual(&d.qacc_smooth, &d.efc_aref, &mut d.efc_b);
}

/// `efc_b` and `efc_state`, for those who read them.
fn details(d: &mut Data, jar: &[f64]) {
    unconstrained_residual(d);
    for i in 0..d.work.jac.blocks.len() {
        let b = d.work.jac.blocks[i];
        by_rows!(b.nrow, R => block_state::<R>(d, &b, jar));
    }
}

fn block_state<const R: usize>(d: &mut Data, b: &Block, jar: &[f64]) {
    if let (Some(shape), Some(x)) = (shape::<R>(d, b), jar[b.rows()].first_chunk::<R>()) {
        let state = shape.state(x);
        d.efc_state[b.rows()].copy_from_slice(&state);
    }
}

/// The degrees of freedom of a tree.
#[inline(always)]
pub(super) fn tree_dofs(m: &Model, tree: usize) -> Range<usize> {
    let first = m.tree_dofadr[tree] as usize;
    first..first + m.tree_dofnum[tree] as usize
}

impl Problem<'_> {
    /// Goes on from a start with the method of the model.
    #[inline(always)]
    fn run(&mut self, from: Reached) {
        match self.m.opt.solver {
            solver::CG => self.conjugate_gradient(from),
            _ => self.newton(from),
        }
    }
}
