//! The constraint rows of the current position: Jacobian, violation, regularization.
//!
//! Order: equalities, dry friction of joints and tendons, limits of joints and tendons, contacts. A row is a scalar
//! `J a`; its regularization R makes it soft.

use super::impedance::Kbi;
use super::{contact, equality, exact, single};
use crate::math::*;
use crate::{Data, Model, disable, enable};

/// `efc_*` up to R and D, `nefc`.
#[inline(never)]
pub(crate) fn make(m: &Model, d: &mut Data) {
    d.work.jac.clear();
    let on = |bit: i32| !m.opt.disabled(disable::CONSTRAINT) && !m.opt.disabled(bit);
    let equal = d.plan.equalities && on(disable::EQUALITY);
    let friction = d.plan.friction_loss && on(disable::FRICTIONLOSS);
    let limits = d.plan.limits && on(disable::LIMIT);
    // Room for all that may come; the arrays keep their length from step to step as long as contacts stay.
    let limits = if limits { single::count_limits(m, d) } else { 0 };
    let mut room = contact::count(m, d) + limits;
    room += if equal { equality::count(m, d) } else { 0 };
    room += if friction { single::count_friction(m) } else { 0 };
    if room > 0 || !d.efc_type.is_empty() {
        resize(d, room);
    }
    (d.nefc, d.ne, d.nf, d.nl) = (0, 0, 0, 0);
    if room == 0 {
        return;
    }
    if equal {
        equality::make(m, d);
    }
    d.ne = d.nefc;
    if friction {
        single::friction(m, d);
    }
    d.nf = d.nefc - d.ne;
    if limits > 0 {
        single::limits(m, d);
    }
    d.nl = d.nefc - d.ne - d.nf;
    contact::make(m, d);
    resize(d, d.nefc);
    let [_, columns, values] = d.work.jac.size();
    d.work.meter.add(60 * d.nefc as u64 + 8 * columns + 2 * values);
    if d.nefc > 0 && m.opt.enabled(enable::DIAGEXACT) {
        exact::regularize(m, d);
    }
}

/// No rows and no contacts.
pub(crate) fn none(d: &mut Data) {
    d.work.jac.clear();
    resize(d, 0);
    (d.nefc, d.ne, d.nf, d.nl, d.nisland) = (0, 0, 0, 0, 0);
    crate::collision::none(d);
}

/// Gives the arrays a length.
pub(super) fn resize(d: &mut Data, rows: usize) {
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

/// The R rows of one constraint.
pub(super) struct Rows<const R: usize> {
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

/// Appends the scalars of a constraint; its Jacobian is there already.
#[inline(always)]
pub(super) fn push<const R: usize>(d: &mut Data, s: &Rows<R>) {
    let rows = d.nefc..d.nefc + R;
    d.nefc = rows.end;
    put(&mut d.efc_type[rows.clone()], [s.kind; R]);
    put(&mut d.efc_id[rows.clone()], [s.id as i32; R]);
    put(&mut d.efc_pos[rows.clone()], s.pos);
    put(&mut d.efc_margin[rows.clone()], s.margin);
    put(&mut d.efc_frictionloss[rows.clone()], [s.loss; R]);
    let kbip = |k: &Kbi| [k.k, k.b, k.imp, k.slope];
    let each = std::array::from_fn(|r| if r == 0 { kbip(&s.kbi) } else { kbip(&s.others) });
    put::<_, R>(&mut rows_mut::<4>(&mut d.efc_KBIP)[rows.clone()], each);
    soften(d, rows.start, s.kbi.imp, &s.r);
}

/// `efc_R`, `efc_D`, and the diagonal of J M⁻¹ Jᵀ that they would follow from.
#[inline(always)]
pub(super) fn soften<const R: usize>(d: &mut Data, row: usize, imp: f64, r: &[f64; R]) {
    let rows = row..row + R;
    put(&mut d.efc_diagA[rows.clone()], r.map(|r| r * imp / (1.0 - imp)));
    put(&mut d.efc_R[rows.clone()], *r);
    put(&mut d.efc_D[rows], r.map(|r| 1.0 / r));
}

#[inline(always)]
fn put<T, const R: usize>(to: &mut [T], values: [T; R]) {
    if let Some(to) = to.first_chunk_mut::<R>() {
        *to = values;
    }
}

/// R = (1 - d)/d A, so that the constraint acts with the fraction d of the force that would hold it rigid.
#[inline]
pub(super) fn regularization(imp: f64, diag: f64) -> f64 {
    ((1.0 - imp) / imp * diag).max(MINVAL)
}
