//! Forces along spatial tendons, as forces on the bodies that they pass: what springs, dampers, constraints and actuators
//! do to the length, seen from outside.

use crate::constraint;
use crate::dynamics::reflected::tendon_inertia;
use crate::forces::passive::spring;
use crate::forces::tendon;
use crate::forces::tendon::spatial_tendon;
use crate::kinds::{disable, trntype};
use crate::math::*;
use crate::model::{Fields, Model};

/// Calls `apply` with each body that some tendon pulls, the point and the force, world.
pub(crate) fn pulls(m: &Model, d: &Fields, mut apply: impl FnMut(usize, Vec3, Vec3)) {
    for t in (0..m.ntendon).filter(|&t| !tendon::is_fixed(m, t)) {
        let force = passive(m, d, t) + actuators(m, d, t) + constraint::tendon_force(m, d, t);
        let force = force - inertial(m, d, t);
        if force != 0.0 {
            spatial_tendon::pull(m, d, t, force, &mut apply);
        }
    }
}

/// The force of the spring and the damper along the length, N.
fn passive(m: &Model, d: &Fields, t: usize) -> f64 {
    let (springs, dampers) = (!m.opt.disabled(disable::SPRING), !m.opt.disabled(disable::DAMPER));
    spring::tendon_force(m, d, t, springs, dampers).into_iter().sum()
}

/// That of actuators.
fn actuators(m: &Model, d: &Fields, t: usize) -> f64 {
    let on = |i: &usize| m.actuator_trntype[*i] == trntype::TENDON && m.actuator_trnid[2 * i] == t as i32;
    let force = |i: usize| {
        let o = m.actuator_outadr[i] as usize;
        m.actuator_gear[6 * o] * d.actuator_force[o]
    };
    if m.opt.disabled(disable::ACTUATION) { 0.0 } else { (0..m.nactuator).filter(on).map(force).sum() }
}

/// What accelerates the inertia of the tendon itself: a (J q̈ + J̇ v), N.
fn inertial(m: &Model, d: &Fields, t: usize) -> f64 {
    let a = tendon_inertia(m, t);
    if a == 0.0 { 0.0 } else { a * (tendon::along(m, d, t, &d.qacc) + spatial_tendon::acceleration(m, d, t)) }
}
