//! The reference acceleration of constraints: that of a damped spring acting on the violation.

use super::ConstraintScratch;
use super::contact_rows;
use super::equality_rows;
use crate::kinds::integrator;
use crate::math::*;
use crate::model::plan::PlanFlag;
use crate::model::{Fields, Model};

/// `efc_vel` = J v and `efc_aref` = -B J v - K d r, minus the velocity-dependent acceleration J̇ v.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn reference(m: &Model, d: &mut Fields, w: &ConstraintScratch) {
    if d.nefc > 0 {
        compute_reference(m, d, w);
    }
}

#[inline(never)]
fn compute_reference(m: &Model, d: &mut Fields, w: &ConstraintScratch) {
    w.jac.mul(&d.qvel, &mut d.efc_vel);
    if d.plan.has(PlanFlag::Surfaces) {
        contact_rows::surfaces(m, d);
    }
    if m.opt.integrator == integrator::DISCRETE {
        // With this integrator, the reference is computed at the end of the step, because it depends on forces.
        return;
    }
    let rows = d.efc_pos.iter().zip(&d.efc_margin).zip(rows::<4>(&d.efc_KBIP)).zip(&d.efc_vel);
    for (aref, (((pos, margin), [k, b, imp, _]), vel)) in d.efc_aref.iter_mut().zip(rows) {
        *aref = -b * vel - k * imp * (pos - margin);
    }
    if d.ne > 0 {
        equality_rows::bias(m, d);
    }
    if d.plan.has(PlanFlag::Adhesion) {
        contact_rows::adhesion(d);
    }
}
