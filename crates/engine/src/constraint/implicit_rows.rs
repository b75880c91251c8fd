//! Constraint rows at the end of a step, for the discrete integrator.
//!
//! The spring and damper of a row act with the violation r + h v⁺ and the velocity v⁺ = v + h a at the end of the
//! step. Solved for the acceleration a, this is again a row: with s = 1 + h B + h² K d, its regularization is R/s and
//! its reference is -((B + h K d) v + K d r)/s (derived from numbers of MuJoCo 3.14.0).

use super::ConstraintScratch;
use super::contact_rows;
use super::cost::Cost;
use super::equality_rows;
use super::jacobian::{ConstraintJacobian, JacobianBlock};
use super::kind;
use super::row_counts::MOST_ROWS;
use super::rows::{resize, soften};
use crate::dynamics::mass;
use crate::math::*;
use crate::model::plan::PlanFlag;
use crate::model::{Fields, Model};

/// Replaces `efc_R` and the quantities derived from it, and sets `efc_aref`. `metric` is the diagonal of the matrix
/// that replaces M.
pub(crate) fn at_end_of_step(m: &Model, d: &mut Fields, w: &ConstraintScratch, metric: &[f64]) {
    for b in &w.jac.blocks {
        soften_block(m, d, &w.jac, metric, b);
    }
    let h = m.opt.timestep;
    for (r, [k, b, imp, _]) in rows::<4>(&d.efc_KBIP).iter().enumerate() {
        let off = d.efc_pos[r] - d.efc_margin[r];
        d.efc_aref[r] = -(b + h * k * imp) * d.efc_vel[r] - k * imp * off;
    }
    if d.ne > 0 {
        equality_rows::bias(m, d);
    }
    for (aref, kbip) in d.efc_aref.iter_mut().zip(rows::<4>(&d.efc_KBIP)) {
        *aref /= growth(h, kbip);
    }
    if d.plan.has(PlanFlag::Adhesion) {
        contact_rows::adhesion(d);
    }
}

/// s = 1 + h B + h² K d
fn growth(h: f64, [k, b, imp, _]: &[f64; 4]) -> f64 {
    1.0 + h * b + h * h * k * imp
}

/// Sets R/s for the rows of a block, scaled to the inertia of the current metric.
fn soften_block(m: &Model, d: &mut Fields, jac: &ConstraintJacobian, metric: &[f64], b: &JacobianBlock) {
    let (row, n) = (b.row as usize, b.nrow as usize);
    // Ratio of Σ J²/M' to Σ J²/M, using only the diagonals.
    let (mut current, mut before) = ([0.0; MOST_ROWS], [0.0; MOST_ROWS]);
    for (&k, v) in jac.terms(b) {
        let k = k as usize;
        let inertia = d.M[mass::diagonal(m, k)];
        for (r, v) in v.iter().enumerate() {
            current[r] += v * v / metric[k];
            before[r] += v * v / inertia;
        }
    }
    let kbip = &rows::<4>(&d.efc_KBIP)[row..];
    let softer = |r: usize| {
        let lighter = if before[r] > 0.0 { current[r] / before[r] } else { 1.0 };
        lighter / growth(m.opt.timestep, &kbip[r])
    };
    let old = &d.efc_R[row..row + n];
    let mut new = [0.0; MOST_ROWS];
    let new = &mut new[..n];
    new.iter_mut().zip(old).enumerate().for_each(|(r, (new, old))| *new = (old * softer(r)).max(MINVAL));
    let (old, first, imp) = (old[0], softer(0), kbip[0][2]);
    let elliptic = d.efc_type[row] == kind::CONTACT_ELLIPTIC;
    if (elliptic || d.efc_type[row] == kind::CONTACT_PYRAMIDAL)
        && let Some(c) = d.contact.get_mut(d.efc_id[row] as usize)
    {
        // The regularization of friction follows from that of the normal. R of an edge is 2 μ² times R of the normal.
        let normal = if elliptic { old } else { old / (2.0 * c.mu * c.mu) };
        contact_rows::frictions(m, c, elliptic, (normal * first).max(MINVAL), new);
    }
    soften(d, row, imp, new);
}

/// Appends a row with the cost ½ `stiff` x² for x = J a: a term of the metric that does not fit into the pattern of
/// M.
pub(crate) fn push_metric(
    d: &mut Fields,
    w: &mut ConstraintScratch,
    columns: &[i32],
    values: &[f64],
    stiff: f64,
) {
    let row = d.nefc;
    resize(d, row + 1);
    d.nefc += 1;
    w.jac.push_sparse(Cost::Quadratic, row, columns, values.iter().copied());
    (d.efc_type[row], d.efc_id[row]) = (kind::EQUALITY, 0);
    (d.efc_aref[row], d.efc_D[row], d.efc_R[row], d.efc_frictionloss[row]) = (0.0, stiff, 1.0 / stiff, 0.0);
}

/// Removes all rows starting at `rows`, and subtracts their force from `qfrc_constraint`.
pub(crate) fn pop_metric(d: &mut Fields, w: &mut ConstraintScratch, rows: usize) {
    while let Some(&b) = w.jac.blocks.last()
        && b.row as usize >= rows
    {
        let opposite = [-d.efc_force[b.row as usize]];
        w.jac.add_transposed(&b, &opposite, &mut d.qfrc_constraint);
        w.jac.pop();
    }
    d.nefc = rows;
    resize(d, rows);
}
