//! Creation of the constraint rows for the current position: Jacobian, violation, regularization.
//!
//! Order: equalities, dry friction of joints and tendons, limits of joints and tendons, contacts.

use super::ConstraintScratch;
use super::contact_rows;
use super::equality_rows;
use super::exact;
use super::rows::resize;
use super::single;
use crate::kinds::{disable, enable};
use crate::model::plan::PlanFlag;
use crate::model::{Fields, Model};

/// Computes `nefc` and `efc_*` up to R and D.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn make(m: &Model, d: &mut Fields, w: &mut ConstraintScratch) {
    w.jac.clear();
    let on = |bit: i32| !m.opt.disabled(disable::CONSTRAINT) && !m.opt.disabled(bit);
    let equal = d.plan.has(PlanFlag::Equalities) && on(disable::EQUALITY);
    let friction = d.plan.has(PlanFlag::FrictionLoss) && on(disable::FRICTIONLOSS);
    let limits = d.plan.has(PlanFlag::Limits) && on(disable::LIMIT);
    // Memory for the maximum number of rows. The arrays keep their length between steps while the contacts do not
    // change.
    let limits = if limits { single::count_limits(m, d) } else { 0 };
    let mut capacity = contact_rows::count(m, d) + limits;
    capacity += if equal { equality_rows::count(m, d) } else { 0 };
    capacity += if friction { single::count_friction(m) } else { 0 };
    if capacity > 0 || !d.efc_type.is_empty() {
        resize(d, capacity);
    }
    (d.nefc, d.ne, d.nf, d.nl) = (0, 0, 0, 0);
    if capacity > 0 {
        fill(m, d, w, [equal, friction, limits > 0]);
    }
}

/// Creates the rows: equalities, dry friction and limits if the model has them, and contacts.
#[inline(never)]
fn fill(m: &Model, d: &mut Fields, w: &mut ConstraintScratch, [equal, friction, limits]: [bool; 3]) {
    if equal {
        equality_rows::make(m, d, w);
    }
    d.ne = d.nefc;
    if friction {
        single::friction(m, d, &mut w.jac);
    }
    d.nf = d.nefc - d.ne;
    if limits {
        single::limits(m, d, &mut w.jac);
    }
    d.nl = d.nefc - d.ne - d.nf;
    contact_rows::make(m, d, w);
    resize(d, d.nefc);
    let [_, columns, values] = w.jac.size();
    d.meter.add(60 * d.nefc as u64 + 8 * columns + 2 * values);
    if d.nefc > 0 && m.opt.enabled(enable::DIAGEXACT) {
        exact::regularize(m, d, w);
    }
}

/// Clears rows and contacts.
pub(crate) fn none(d: &mut Fields, w: &mut ConstraintScratch) {
    w.jac.clear();
    resize(d, 0);
    (d.nefc, d.ne, d.nf, d.nl, d.nisland) = (0, 0, 0, 0, 0);
    crate::collision::none(d);
}
