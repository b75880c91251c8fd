//! The primal problem of one island, and the parts common to the primal methods: cost, forces and gradient at the
//! current acceleration, the exact line search, and the loop over search directions.

use super::cost::{Cost, CostParameters, clamp_unilateral, unilateral_along};
use super::island::Islands;
use super::iterate::{IslandProgress, Iterate};
use super::jacobian::{ConstraintJacobian, JacobianBlock};
use super::row_counts::by_rows;
use super::search::{Point, minimize};
use crate::dynamics::{DynamicsScratch, mass, tree_algorithms};
use crate::kinds::{disable, solver};
use crate::math::{MINVAL, combine, dot, dot_slice, sum, zero};
use crate::model::{Fields, Model};
use std::ops::Range;

/// What is known of the cost at the start of a search direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Direction {
    /// The slope. For a Newton direction the curvature is minus the slope. The first direction leads exactly to the
    /// minimum, unless a constraint changes its zone on the way. Later directions may be so short that they consist
    /// of rounding errors.
    Newton { slope: f64, first: bool },
    /// No information.
    Other,
}

/// One island: its trees and constraints.
pub(super) struct PrimalProblem<'a> {
    pub(super) m: &'a Model,
    pub(super) d: &'a mut Fields,
    pub(super) s: &'a mut Iterate,
    pub(super) trees: &'a mut DynamicsScratch,
    pub(super) jac: &'a ConstraintJacobian,
    pub(super) islands: &'a Islands,
    pub(super) island: usize,
}

impl<'a> PrimalProblem<'a> {
    /// Computes forces, cost and gradient at the current acceleration. Also tests whether it is already the minimum:
    /// the gradient, and the decrease that M⁻¹ predicts, are both small.
    pub(super) fn evaluate_start(&mut self) -> IslandProgress {
        let (tol, scale) = (self.m.opt.tolerance, self.scale());
        let (cost, gradient) = self.update();
        let small = scale * gradient < tol || self.m.opt.solver == solver::CG;
        let diagonal = self.m.nC == self.m.nv;
        let mut decrement = || if diagonal { self.decrement_by_diagonal() } else { self.decrement_by_mass() };
        let minimum = small && scale * decrement() < tol;
        IslandProgress { cost, gradient, scale, minimum }
    }

    /// Reduces the cost along successive directions. `direct` writes the next direction to `search` and returns what
    /// is known of it, or `None` to stop. Its argument is the norm of the gradient before the last step, `None` for
    /// the first direction. A step costs `price` work units.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(super) fn descend(
        &mut self,
        from: IslandProgress,
        price: u64,
        mut direct: impl FnMut(&mut Self, Option<f64>) -> Option<Direction>,
    ) {
        let tol = self.m.opt.tolerance;
        let IslandProgress { mut cost, mut gradient, scale, .. } = from;
        let Some(mut direction) = direct(self, None) else { return };
        for _ in 0..self.m.opt.iterations.max(0) {
            let alpha = self.line_search(scale, direction);
            self.d.meter.add(price);
            if alpha == 0.0 || self.d.meter.over() {
                break;
            }
            self.advance(alpha);
            self.d.solver_niter += 1;
            let before = (cost, gradient);
            (cost, gradient) = self.update();
            let improvement = scale * (before.0 - cost);
            if (improvement > 0.0 && improvement < tol) || scale * gradient < tol {
                break;
            }
            let Some(next) = direct(self, Some(before.1)) else { break };
            direction = next;
        }
    }

    /// Work units of one pass over the rows and degrees of freedom of the island, and of the products of columns.
    pub(super) fn pass_costs(&self) -> [u64; 2] {
        let [blocks, columns, values] = self.jac.size();
        let (own_blocks, all) = (self.islands.blocks.len(self.island) as u64, blocks.max(1));
        let dofs: usize = self.dofs().map(|r| r.len()).sum();
        [
            50 + own_blocks * (15 + 2 * values / all) + 5 * dofs as u64,
            own_blocks * (values / all) * (columns / all) / 2,
        ]
    }

    /// The degrees of freedom of the island.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(super) fn dofs(&self) -> impl Iterator<Item = Range<usize>> + Clone + use<'a> {
        self.islands.dofs(self.island)
    }

    /// The constraints of the island, as indexes of the blocks of the Jacobian.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(super) fn blocks(&self) -> impl Iterator<Item = usize> + Clone + use<'a> {
        self.islands.blocks.members(self.island)
    }

    /// Factor that makes costs and gradients comparable between scenes of different mass.
    pub(super) fn scale(&self) -> f64 {
        let m = self.m;
        if m.opt.disabled(disable::ISLAND) {
            return self.scale_of_all();
        }
        let sum: f64 = self.dofs().map(|dofs| mass::trace(m, &self.d.M, dofs)).sum();
        1.0 / sum.max(MINVAL)
    }

    /// The same factor for the whole scene; the dual methods use it for every island.
    pub(super) fn scale_of_all(&self) -> f64 {
        1.0 / (self.m.stat.meaninertia * self.m.nv.max(1) as f64).max(MINVAL)
    }

    /// Computes forces and gradient at the current acceleration. `qfrc_constraint` must be zero before. Returns the
    /// cost and the norm of the gradient.
    pub(super) fn update(&mut self) -> (f64, f64) {
        let mut cost = 0.0;
        let jac = self.jac;
        for b in self.blocks() {
            let b = &jac.blocks[b];
            cost += match (b.cost, b.nrow) {
                (Cost::Unilateral, 1) => self.push_block::<1>(b),
                (Cost::Unilateral, 4) => self.push_block::<4>(b),
                _ => by_rows!(b.nrow, R => self.other_block::<R>(b)),
            };
        }
        let mut square = 0.0;
        for dofs in self.dofs() {
            let (d, s) = (&*self.d, &mut *self.s);
            let (ma, smooth, grad) =
                (&s.ma[dofs.clone()], &d.qfrc_smooth[dofs.clone()], &mut s.grad[dofs.clone()]);
            combine(grad, [ma, smooth, &d.qfrc_constraint[dofs.clone()]], |_, [ma, f0, f]| ma - f0 - f);
            square += sum([grad], |[g]| g * g);
            let (a, a0) = (&d.qacc[dofs.clone()], &d.qacc_smooth[dofs]);
            cost += 0.5 * sum([ma, smooth, a, a0], |[ma, f0, a, a0]| (ma - f0) * (a - a0));
        }
        (cost, square.sqrt())
    }

    /// Computes the forces of a block of unilateral rows. Returns its cost.
    #[cfg_attr(not(feature = "small"), inline(always))]
    fn push_block<const R: usize>(&mut self, b: &JacobianBlock) -> f64 {
        let (d, s) = (&mut *self.d, &*self.s);
        let rows = b.rows();
        let (Some(x), Some(w)) =
            (s.jar[rows.clone()].first_chunk::<R>(), d.efc_D[rows.clone()].first_chunk::<R>())
        else {
            return 0.0;
        };
        let below: [f64; R] = x.map(clamp_unilateral);
        let force: [f64; R] = std::array::from_fn(|r| -w[r] * below[r]);
        d.efc_force[rows].copy_from_slice(&force);
        self.jac.add_transposed(b, &force, &mut d.qfrc_constraint);
        -0.5 * dot(force, below)
    }

    /// Computes the forces of a block of any other kind. Returns its cost.
    #[inline(never)]
    fn other_block<const R: usize>(&mut self, b: &JacobianBlock) -> f64 {
        let (d, s) = (&mut *self.d, &*self.s);
        let (Some(shape), Some(x)) = (shape::<R>(d, b), s.jar[b.rows()].first_chunk::<R>()) else {
            return 0.0;
        };
        let (cost, force) = shape.value(x);
        d.efc_force[b.rows()].copy_from_slice(&force);
        self.jac.add_transposed(b, &force, &mut d.qfrc_constraint);
        cost
    }

    /// Returns ½ gᵀ M⁻¹ g. Also sets step ← M⁻¹ g.
    pub(super) fn decrement_by_mass(&mut self) -> f64 {
        tree_algorithms::complete(self.m, self.d, self.trees);
        for dofs in self.dofs() {
            self.s.step[dofs.clone()].copy_from_slice(&self.s.grad[dofs.clone()]);
            mass::solve(self.m, &self.d.qLD, &self.d.qLDiagInv, &mut self.s.step, dofs);
        }
        self.decrement()
    }

    /// ½ gᵀ M⁻¹ g for a diagonal M.
    fn decrement_by_diagonal(&mut self) -> f64 {
        tree_algorithms::complete(self.m, self.d, self.trees);
        let decrement =
            |r: Range<usize>| sum([&self.d.qLDiagInv[r.clone()], &self.s.grad[r]], |[inv, g]| inv * g * g);
        0.5 * self.dofs().map(decrement).sum::<f64>()
    }

    /// ½ gᵀ step.
    pub(super) fn decrement(&self) -> f64 {
        0.5 * self.dofs().map(|r| dot_slice(&self.s.grad[r.clone()], &self.s.step[r])).sum::<f64>()
    }

    /// The step length along `search` with the lowest cost.
    pub(super) fn line_search(&mut self, scale: f64, direction: Direction) -> f64 {
        let price = 20 + 12 * self.islands.blocks.len(self.island) as u64;
        let most = (self.d.meter.left() / price).max(16);
        let mut evaluations = 0;
        let (dofs, blocks) = (self.dofs(), self.blocks());
        let (m, d, s) = (self.m, &*self.d, &mut *self.s);
        for dofs in dofs.clone() {
            mass::mul(m, &d.M, &s.search, &mut s.mv, dofs);
        }
        for b in blocks.clone() {
            self.jac.mul_block(&self.jac.blocks[b], &s.search, &mut s.jv);
        }
        let first = matches!(direction, Direction::Newton { first: true, .. });
        if first && blocks.clone().all(|b| is_quadratic_along(d, s, &self.jac.blocks[b])) {
            return 1.0;
        }
        let (mut length, mut linear, mut quadratic) = (0.0, 0.0, 0.0);
        for k in dofs.flatten() {
            length += s.search[k] * s.search[k];
            linear += s.search[k] * (s.ma[k] - d.qfrc_smooth[k]);
            quadratic += 0.5 * s.search[k] * s.mv[k];
        }
        let length = length.sqrt();
        if length < MINVAL {
            return 0.0;
        }
        let gtol = m.opt.tolerance * m.opt.ls_tolerance * length / scale;
        let most = most.min(m.opt.ls_iterations.max(0) as u64) as usize;
        let mut eval = |alpha| {
            evaluations += 1;
            let mut p = Point {
                alpha,
                cost: alpha * (linear + alpha * quadratic),
                slope: linear + 2.0 * alpha * quadratic,
                curvature: 2.0 * quadratic,
            };
            for b in blocks.clone() {
                let b = &self.jac.blocks[b];
                if b.cost == Cost::Unilateral {
                    add_push(&mut p, d, s, b);
                } else {
                    by_rows!(b.nrow, R => add_other::<R>(&mut p, d, s, b));
                }
            }
            p
        };
        let start = match direction {
            Direction::Newton { slope, .. } => Point { alpha: 0.0, cost: 0.0, slope, curvature: -slope },
            Direction::Other => eval(0.0),
        };
        let best = minimize(gtol, most, start, eval);
        self.d.meter.add(evaluations * price);
        best
    }

    /// a ← a + α search. Also sets `qfrc_constraint` to zero, for the next [`PrimalProblem::update`].
    pub(super) fn advance(&mut self, alpha: f64) {
        let (dofs, blocks) = (self.dofs(), self.blocks());
        let (d, s) = (&mut *self.d, &mut *self.s);
        for k in dofs {
            zero(&mut d.qfrc_constraint[k.clone()]);
            combine(&mut d.qacc[k.clone()], [&s.search[k.clone()]], |a, [step]| a + alpha * step);
            combine(&mut s.ma[k.clone()], [&s.mv[k]], |ma, [step]| ma + alpha * step);
        }
        for b in blocks {
            let rows = self.jac.blocks[b].rows();
            for (x, v) in s.jar[rows.clone()].iter_mut().zip(&s.jv[rows]) {
                *x += alpha * v;
            }
        }
    }
}

/// The parameters of the cost of a constraint of R rows.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn shape<'a, const R: usize>(d: &'a Fields, b: &JacobianBlock) -> Option<CostParameters<'a, R>> {
    let row = b.row as usize;
    let contact = if b.cost == Cost::Cone { d.contact.get(d.efc_id[row] as usize) } else { None };
    let stiff = d.efc_D[b.rows()].first_chunk::<R>()?;
    Some(CostParameters { cost: b.cost, stiff, loss: d.efc_frictionloss[row], contact })
}

/// Whether the cost of a block is a single quadratic function along the whole step `search`.
#[cfg_attr(not(feature = "small"), inline(always))]
fn is_quadratic_along(d: &Fields, s: &Iterate, b: &JacobianBlock) -> bool {
    match b.cost {
        Cost::Quadratic => true,
        Cost::Unilateral => b.rows().all(|r| (s.jar[r] < 0.0) == (s.jar[r] + s.jv[r] < 0.0)),
        _ => by_rows!(b.nrow, R => is_quadratic_along_other::<R>(d, s, b)),
    }
}

/// The same test for a constraint that is not unilateral.
#[inline(never)]
fn is_quadratic_along_other<const R: usize>(d: &Fields, s: &Iterate, b: &JacobianBlock) -> bool {
    match (shape::<R>(d, b), s.jar[b.rows()].first_chunk(), s.jv[b.rows()].first_chunk()) {
        (Some(shape), Some(x), Some(v)) => shape.is_quadratic_along(x, v),
        _ => false,
    }
}

/// Adds the rows of a unilateral block to a point of the line.
#[cfg_attr(not(feature = "small"), inline(always))]
fn add_push(p: &mut Point, d: &Fields, s: &Iterate, b: &JacobianBlock) {
    for r in b.rows() {
        let [cost, slope, curvature] = unilateral_along(s.jar[r], s.jv[r], p.alpha, d.efc_D[r]);
        p.slope += slope;
        p.curvature += curvature;
        p.cost += cost;
    }
}

/// Adds a constraint of any other kind to a point of the line.
#[inline(never)]
fn add_other<const R: usize>(p: &mut Point, d: &Fields, s: &Iterate, b: &JacobianBlock) {
    let (Some(x), Some(v)) = (s.jar[b.rows()].first_chunk::<R>(), s.jv[b.rows()].first_chunk::<R>()) else {
        return;
    };
    if let Some(shape) = shape::<R>(d, b) {
        let [cost, slope, curvature] = shape.along(x, v, p.alpha);
        p.cost += cost;
        p.slope += slope;
        p.curvature += curvature;
    }
}
