//! The scalars of constraint rows: type, violation, stiffness, regularization.
//!
//! A row is a scalar constraint on J a. Its regularization R makes it soft.

use super::impedance::Kbi;
use crate::math::*;
use crate::model::{Fields, Model};

/// Sets the length of the `efc_*` arrays.
pub(super) fn resize(d: &mut Fields, rows: usize) {
    if d.efc_type.len() == rows && d.efc_force.len() == rows {
        return;
    }
    for v in [&mut d.efc_type, &mut d.efc_id, &mut d.efc_state] {
        v.resize(rows, 0);
    }
    d.efc_KBIP.resize(4 * rows, 0.0);
    let floats = [&mut d.efc_pos, &mut d.efc_margin, &mut d.efc_frictionloss, &mut d.efc_diagA];
    let more = [&mut d.efc_D, &mut d.efc_R, &mut d.efc_vel, &mut d.efc_aref, &mut d.efc_b, &mut d.efc_force];
    for v in floats.into_iter().chain(more) {
        v.resize(rows, 0.0);
    }
}

/// Sum of the inverse weights of both bodies, for translation (0) or rotation (1).
#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn inverse_weight(m: &Model, [b1, b2]: [usize; 2], part: usize) -> f64 {
    m.body_invweight0[2 * b1 + part] + m.body_invweight0[2 * b2 + part]
}

/// The R rows of one constraint.
pub(super) struct ConstraintRows<const R: usize> {
    /// `efc_type` and `efc_id`.
    pub(super) kind: i32,
    pub(super) id: usize,
    pub(super) pos: [f64; R],
    pub(super) margin: [f64; R],
    pub(super) loss: f64,
    /// Stiffness, damping and impedance of the first row, and of the others.
    pub(super) kbi: Kbi,
    pub(super) others: Kbi,
    /// Regularization.
    pub(super) r: [f64; R],
}

/// Appends the scalar quantities of a constraint, after its Jacobian.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn push<const R: usize>(d: &mut Fields, s: &ConstraintRows<R>) {
    append(d, s.kind, s.id, s.loss, [&s.pos, &s.margin, &s.r], [&s.kbi, &s.others]);
}

#[cfg_attr(not(feature = "small"), inline(always))]
fn append(d: &mut Fields, kind: i32, id: usize, loss: f64, [pos, margin, r]: [&[f64]; 3], kbi: [&Kbi; 2]) {
    let rows = d.nefc..d.nefc + r.len();
    d.nefc = rows.end;
    d.efc_type[rows.clone()].fill(kind);
    d.efc_id[rows.clone()].fill(id as i32);
    d.efc_pos[rows.clone()].copy_from_slice(pos);
    d.efc_margin[rows.clone()].copy_from_slice(margin);
    d.efc_frictionloss[rows.clone()].fill(loss);
    let [first, others] = kbi.map(|k| [k.k, k.b, k.imp, k.slope]);
    let kbip = &mut rows_mut::<4>(&mut d.efc_KBIP)[rows.clone()];
    kbip.fill(others);
    kbip[0] = first;
    soften(d, rows.start, kbi[0].imp, r);
}

/// Sets `efc_R`, `efc_D`, and `efc_diagA`, the diagonal of J M⁻¹ Jᵀ that corresponds to R.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn soften(d: &mut Fields, row: usize, imp: f64, r: &[f64]) {
    let rows = row..row + r.len();
    let put = |to: &mut [f64], function: &dyn Fn(f64) -> f64| {
        to.iter_mut().zip(r).for_each(|(to, r)| *to = function(*r))
    };
    put(&mut d.efc_diagA[rows.clone()], &|r| r * imp / (1.0 - imp));
    put(&mut d.efc_R[rows.clone()], &|r| r);
    put(&mut d.efc_D[rows], &|r| 1.0 / r);
}

/// R = (1 - d)/d A, so that the constraint acts with the fraction d of the force that would make it rigid.
#[inline]
pub(super) fn regularization(imp: f64, diag: f64) -> f64 {
    ((1.0 - imp) / imp * diag).max(MINVAL)
}
