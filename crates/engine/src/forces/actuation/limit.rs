//! Force limits: for all actuators of a tendon together, for each actuator, and for all actuators of a joint together.

use crate::forces::ForceScratch;
use crate::kinds::{gaintype, joint, trntype};
use crate::math::*;
use crate::model::{Fields, Model};

/// Scales the actuator forces on a tendon if their sum is outside its range.
pub(super) fn tendons(m: &Model, d: &mut Fields, w: &mut ForceScratch) {
    if !m.tendon_actfrclimited.contains(&true) {
        return;
    }
    let limited = |i: usize| {
        let t = m.actuator_trnid[2 * i] as usize;
        (m.actuator_trntype[i] == trntype::TENDON && m.tendon_actfrclimited[t]).then_some(t)
    };
    let sums = &mut w.tendon_force;
    sums.fill(0.0);
    for i in 0..m.nactuator {
        if let Some(t) = limited(i) {
            sums[t] += d.actuator_force[m.actuator_outadr[i] as usize];
        }
    }
    for i in 0..m.nactuator {
        let Some(t) = limited(i).filter(|&t| sums[t] != 0.0) else { continue };
        let within = clip(sums[t], rows::<2>(&m.tendon_actfrcrange)[t]);
        if within != sums[t] {
            d.actuator_force[m.actuator_outadr[i] as usize] *= within / sums[t];
        }
    }
}

/// Clamps the force of each actuator. For an orientation servo, clamps the magnitude of its torque.
pub(super) fn forces(m: &Model, d: &mut Fields) {
    for i in (0..m.nactuator).filter(|&i| m.actuator_forcelimited[i]) {
        let range = rows::<2>(&m.actuator_forcerange)[i];
        let first = m.actuator_outadr[i] as usize;
        let force = &mut d.actuator_force[first..first + m.actuator_outnum[i] as usize];
        if m.actuator_gaintype[i] == gaintype::SO3 {
            let length = force.iter().map(|f| f * f).sum::<f64>().sqrt();
            if length > range[1] {
                force.iter_mut().for_each(|f| *f *= range[1] / length);
            }
        } else {
            force.iter_mut().for_each(|f| *f = clip(*f, range));
        }
    }
}

/// Clamps the total actuator force on each slide and hinge.
pub(super) fn joints(m: &Model, d: &mut Fields) {
    for j in (0..m.njnt).filter(|&j| m.jnt_actfrclimited[j]) {
        if matches!(m.jnt_type[j], joint::SLIDE | joint::HINGE) {
            let force = &mut d.qfrc_actuator[m.jnt_dofadr[j] as usize];
            *force = clip(*force, rows::<2>(&m.jnt_actfrcrange)[j]);
        }
    }
}
