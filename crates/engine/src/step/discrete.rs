//! The discrete integrator: one linear problem whose solution is the velocity at the end of the step.
//!
//! With the stiffness K and the damping D of springs, dampers, actuators and the fluid at the start of the step, the forces at
//! its end are f - h K v - (h D + h² K) a, so that
//!
//! > (M + h D + h² K) a = f - h K v
//!
//! and a is exactly (v⁺ - v)/h. Coefficients that would destabilize the step are left out. The matrix on the left is called the
//! metric. It replaces M in the dynamics of this integrator.

use super::metric::Metric;
use super::workspace::StepScratch;
use crate::constraint;
use crate::math::{Spatial, dot, solve_six};
use crate::model::{Fields, Model, asleep};

/// `qacc_smooth`.
pub(crate) fn acceleration(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    let mut out = std::mem::take(&mut d.qacc_smooth);
    s.metric.build(m, d, &mut s.derivative);
    s.metric.solve(m, d, &mut out);
    d.qacc_smooth = out;
}

/// For free rigid bodies that are not coupled with others, adds the derivative of the gyroscopic force to `qacc`.
pub(crate) fn add_gyroscopic_correction(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    let StepScratch { metric: w, derivative: slopes, constraint: rows, .. } = s;
    for tree in 0..m.ntree {
        if asleep::tree(m, d, tree) {
            continue;
        }
        if let Some((first, mut a)) = w.free_block(m, d, slopes, rows, tree) {
            let mut f: Spatial = std::array::from_fn(|r| w.force[first + r]);
            if solve_six(&mut a, &mut f) {
                d.qacc[first..first + 6].copy_from_slice(&f);
            }
        }
    }
}

/// Adds to `qfrc_inverse` the product of `qacc` with the metric minus M, and h K v.
pub(crate) fn add_to_inverse(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    let StepScratch { metric: w, derivative: slopes, constraint: rows, .. } = s;
    w.build(m, d, slopes);
    w.search.copy_from_slice(&d.qacc);
    w.multiply(m, d);
    for tree in 0..m.ntree {
        if let Some((first, a)) = w.free_block(m, d, slopes, rows, tree) {
            let x: Spatial = std::array::from_fn(|r| d.qacc[first + r]);
            for (f, row) in w.product[first..first + 6].iter_mut().zip(a) {
                *f = dot(row, x);
            }
        }
    }
    for i in 0..m.nv {
        // The product contains that with M.
        d.qfrc_inverse[i] = w.product[i] + d.qfrc_smooth[i] - w.force[i];
    }
}

/// Sets the constraint rows for the end of the step, for inverse dynamics, in which the metric is not yet available.
pub(crate) fn prepare_inverse(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    let StepScratch { metric: w, derivative: slopes, constraint: rows, .. } = s;
    w.build(m, d, slopes);
    constraint::at_end_of_step(m, d, rows, &w.diagonal);
}

/// `qacc` and constraint forces, with the metric that [`acceleration`] has built. The terms of the metric are additional rows.
pub(crate) fn constraints(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    let StepScratch { metric: w, constraint: rows, dynamics: trees, .. } = s;
    if d.nefc > 0 {
        constraint::at_end_of_step(m, d, rows, &w.diagonal);
    }
    let row_count = d.nefc;
    let separate_terms = row_count > 0 && !w.terms.is_empty();
    if separate_terms {
        for term in &w.terms {
            let (dofs, values) = term.row.jacobian(m, d);
            w.columns.clear();
            w.columns.extend_from_slice(dofs);
            w.values.clear();
            w.values.extend_from_slice(values);
            constraint::push_metric(d, rows, &w.columns, &w.values, term.scale);
        }
        w.solve_without_mass_rows(m, &mut d.qacc_smooth);
    }
    exchange_metric(d, w);
    constraint::solve(m, d, rows, trees);
    exchange_metric(d, w);
    if separate_terms {
        constraint::pop_metric(d, rows, row_count);
        std::mem::swap(&mut w.other, &mut d.qacc_smooth);
        constraint::unconstrained_residual(d, &rows.jac);
    }
}

/// Exchanges the mass matrix and the metric, so that constraints are solved with the metric.
fn exchange_metric(d: &mut Fields, w: &mut Metric) {
    std::mem::swap(&mut d.M, &mut w.matrix);
    std::mem::swap(&mut d.qLD, &mut w.ld);
    std::mem::swap(&mut d.qLDiagInv, &mut w.diag_inv);
    std::mem::swap(&mut d.qfrc_smooth, &mut w.force);
}
