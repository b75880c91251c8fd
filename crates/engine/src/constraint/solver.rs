//! The constraint solver: its starting point, and the method that is used for each island.
//!
//! min over a of ½ (a - a₀)ᵀ M (a - a₀) + Σ s(J a - aref), where a₀ is the unconstrained acceleration and s is the
//! cost of the deviation from the reference acceleration (Todorov 2014).

use super::ConstraintScratch;
use super::cost::{Cost, clamp_unilateral};
use super::island::Islands;
use super::iterate::{IslandProgress, Iterate};
use super::jacobian::{ConstraintJacobian, JacobianBlock};
use super::primal::{PrimalProblem, shape};
use super::row_counts::by_rows;
use crate::dynamics::{DynamicsScratch, mass, tree_algorithms};
use crate::kinds::{disable, solver};
use crate::math::{copy, zero};
use crate::model::plan::PlanFlag;
use crate::model::{Fields, Model};

/// Computes `qacc`, `efc_force`, `qfrc_constraint` and `solver_niter` from `qacc_smooth` and the rows.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn solve(m: &Model, d: &mut Fields, w: &mut ConstraintScratch, trees: &mut DynamicsScratch) {
    d.solver_niter = 0;
    d.nisland = 0;
    copy(&d.qacc_smooth, &mut d.qacc);
    zero(&mut d.qfrc_constraint);
    if d.nefc > 0 {
        solve_rows(m, d, w, trees);
    }
}

#[inline(never)] // so that steps without constraint rows do not execute its setup code
fn solve_rows(m: &Model, d: &mut Fields, w: &mut ConstraintScratch, trees: &mut DynamicsScratch) {
    let [_, columns, values] = w.jac.size();
    d.meter.add(8 * (columns + values) + 40 * d.nefc as u64);
    let dual = m.opt.solver == solver::PGS || m.opt.noslip_iterations > 0;
    if dual {
        // For each row, a system with M of its trees is solved.
        d.meter.add(d.nefc as u64 * 2 * m.nC as u64 / m.ntree.max(1) as u64);
    }
    if d.meter.over() {
        return;
    }
    let ConstraintScratch { jac, islands, solver: s, .. } = w;
    d.nisland = islands.find(m, jac);
    s.resize(m.nv, d.nefc);
    if dual {
        unconstrained_residual(d, jac);
        tree_algorithms::complete(m, d, trees);
        s.dual.build(m, d, jac);
    }
    if m.opt.solver == solver::PGS {
        dual_start(m, d, s, trees, islands, jac);
    } else {
        primal(m, d, s, trees, islands, jac);
    }
    if dual {
        for island in 0..d.nisland {
            let mut problem = PrimalProblem { m, d, s, trees, islands, jac, island };
            if m.opt.solver == solver::PGS {
                problem.gauss_seidel();
            }
            if m.opt.noslip_iterations > 0 {
                problem.remove_slip();
            }
            problem.finish_dual();
        }
    }
    if d.plan.has(PlanFlag::SolverDetails) {
        details(d, jac, &s.jar);
    }
}

/// Newton's method or conjugate gradients, from the better of two starting points.
#[cfg_attr(not(feature = "small"), inline(always))]
fn primal(
    m: &Model,
    d: &mut Fields,
    s: &mut Iterate,
    trees: &mut DynamicsScratch,
    islands: &Islands,
    jac: &ConstraintJacobian,
) {
    if !m.opt.disabled(disable::WARMSTART) && warm_start(m, d, s, trees, islands, jac) {
        return;
    }
    copy(&d.qacc_smooth, &mut d.qacc);
    zero(&mut d.qfrc_constraint);
    copy(&d.qfrc_smooth, &mut s.ma);
    jac.residual(&d.qacc_smooth, &d.efc_aref, &mut s.jar);
    for island in 0..d.nisland {
        let mut problem = PrimalProblem { m, d, s, trees, islands, jac, island };
        let from = problem.evaluate_start();
        problem.run(from);
    }
}

/// Sets the starting forces of the dual method: those at the acceleration of the last step, or zero if zero forces
/// have a lower cost.
fn dual_start(
    m: &Model,
    d: &mut Fields,
    s: &mut Iterate,
    trees: &mut DynamicsScratch,
    islands: &Islands,
    jac: &ConstraintJacobian,
) {
    d.efc_force.fill(0.0);
    if m.opt.disabled(disable::WARMSTART) {
        return;
    }
    jac.residual(&d.qacc_warmstart, &d.efc_aref, &mut s.jar);
    let mut cost = 0.0;
    for island in 0..d.nisland {
        let mut problem = PrimalProblem { m, d, s, trees, islands, jac, island };
        problem.update();
        cost += problem.dual_cost();
    }
    if cost > 0.0 {
        d.efc_force.fill(0.0);
    }
}

/// Computes `efc_force` and `qfrc_constraint` for the acceleration `qacc` (`mj_invConstraint`).
pub(crate) fn inverse(m: &Model, d: &mut Fields, w: &mut ConstraintScratch, trees: &mut DynamicsScratch) {
    d.qfrc_constraint.fill(0.0);
    if d.nefc == 0 {
        return;
    }
    let ConstraintScratch { jac, islands, solver: s, .. } = w;
    d.nisland = islands.find(m, jac);
    s.resize(m.nv, d.nefc);
    s.ma.fill(0.0);
    jac.residual(&d.qacc, &d.efc_aref, &mut s.jar);
    for island in 0..d.nisland {
        PrimalProblem { m, d, s, trees, islands, jac, island }.update();
    }
}

/// Starts from the acceleration of the last step, and continues from there unless the unconstrained acceleration has
/// a lower cost. Returns `true` if the problem is solved. At rest, the last acceleration is still the solution, and
/// the cost of the unconstrained one is not computed.
///
/// The choice is made once for the whole system. Trees without constraints keep the unconstrained acceleration.
#[inline(never)]
fn warm_start(
    m: &Model,
    d: &mut Fields,
    s: &mut Iterate,
    trees: &mut DynamicsScratch,
    islands: &Islands,
    jac: &ConstraintJacobian,
) -> bool {
    jac.residual(&d.qacc_warmstart, &d.efc_aref, &mut s.jar);
    for tree in 0..m.ntree {
        mass::mul(m, &d.M, &d.qacc_warmstart, &mut s.ma, m.tree_dofs(tree));
    }
    let mut progress = std::mem::take(&mut s.progress);
    progress.clear();
    for island in 0..d.nisland {
        for dofs in islands.dofs(island) {
            copy(&d.qacc_warmstart[dofs.clone()], &mut d.qacc[dofs]);
        }
        progress.push(PrimalProblem { m, d, s, trees, islands, jac, island }.evaluate_start());
    }
    let mut done = progress.iter().all(|r| r.minimum);
    if !done {
        // The Gauss cost of the unconstrained acceleration is zero. That of the last acceleration includes the trees
        // outside of islands.
        let gauss = |k: usize| 0.5 * (s.ma[k] - d.qfrc_smooth[k]) * (d.qacc_warmstart[k] - d.qacc_smooth[k]);
        let unconstrained =
            (0..m.ntree).filter(|&tree| !islands.has(tree)).flat_map(|tree| m.tree_dofs(tree));
        let warm = progress.iter().map(|r| r.cost).sum::<f64>() + unconstrained.map(gauss).sum::<f64>();
        // If all costs are quadratic, Newton's first step reaches the minimum from any starting point.
        let quadratic =
            || m.opt.solver == solver::NEWTON && jac.blocks.iter().all(|b| b.cost == Cost::Quadratic);
        if quadratic() || !costs_less(d, jac, s, warm) {
            for (island, &from) in progress.iter().enumerate() {
                PrimalProblem { m, d, s, trees, islands, jac, island }.run(from);
            }
            done = true;
        }
    }
    s.progress = progress;
    done
}

/// Whether the unconstrained acceleration has a cost lower than `most`. Costs are not negative, so the summation
/// stops as soon as it reaches `most`.
fn costs_less(d: &Fields, jac: &ConstraintJacobian, s: &mut Iterate, most: f64) -> bool {
    let cost_of = |x: f64, w: f64| 0.5 * w * clamp_unilateral(x) * clamp_unilateral(x);
    let mut cost = 0.0;
    for b in &jac.blocks {
        jac.mul_block(b, &d.qacc_smooth, &mut s.jv);
        for r in b.rows() {
            s.jv[r] -= d.efc_aref[r];
        }
        cost += match b.cost {
            Cost::Unilateral => b.rows().map(|r| cost_of(s.jv[r], d.efc_D[r])).sum(),
            _ => by_rows!(b.nrow, R => block_cost::<R>(d, b, &s.jv)),
        };
        if cost >= most {
            return false;
        }
    }
    // If a cost is NaN, the last acceleration is discarded.
    cost < most || most.is_nan() || cost.is_nan()
}

fn block_cost<const R: usize>(d: &Fields, b: &JacobianBlock, x: &[f64]) -> f64 {
    match (shape::<R>(d, b), x[b.rows()].first_chunk::<R>()) {
        (Some(shape), Some(x)) => shape.value(x).0,
        _ => 0.0,
    }
}

/// `efc_b`.
pub(crate) fn unconstrained_residual(d: &mut Fields, jac: &ConstraintJacobian) {
    jac.residual(&d.qacc_smooth, &d.efc_aref, &mut d.efc_b);
}

/// Computes `efc_b` and `efc_state`, if they are read.
fn details(d: &mut Fields, jac: &ConstraintJacobian, jar: &[f64]) {
    unconstrained_residual(d, jac);
    for i in 0..jac.blocks.len() {
        let b = jac.blocks[i];
        by_rows!(b.nrow, R => block_state::<R>(d, &b, jar));
    }
}

fn block_state<const R: usize>(d: &mut Fields, b: &JacobianBlock, jar: &[f64]) {
    if let (Some(shape), Some(x)) = (shape::<R>(d, b), jar[b.rows()].first_chunk::<R>()) {
        let state = shape.state(x);
        d.efc_state[b.rows()].copy_from_slice(&state);
    }
}

impl PrimalProblem<'_> {
    /// Solves the problem from a starting point, with the method that the model selects.
    #[cfg_attr(not(feature = "small"), inline(always))]
    fn run(&mut self, from: IslandProgress) {
        match self.m.opt.solver {
            solver::CG => self.conjugate_gradient(from),
            _ => self.newton(from),
        }
    }
}
