//! Reflected inertia and damping: what actuators add to the joints and tendons that they act on, and the inertia of
//! tendons.
//!
//! With a gear ratio g, a rotor turns g times as fast as the joint, so its inertia and damping are multiplied by g².

use crate::kinds::trntype;
use crate::model::Model;

/// The object that actuator `i` acts on, and the second site if there is one.
pub fn target(m: &Model, i: usize) -> (usize, Option<usize>) {
    (m.actuator_trnid[2 * i] as usize, usize::try_from(m.actuator_trnid[2 * i + 1]).ok())
}

/// The joint or tendon to which an actuator adds inertia and damping.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum On {
    Joint(usize),
    Tendon(usize),
}

/// The range of actuators that may add inertia or damping to a joint or tendon.
#[cfg_attr(not(feature = "small"), inline(always))]
fn actuators(m: &Model, on: On) -> std::ops::Range<usize> {
    let id = match on {
        On::Joint(j) => m.jnt_actuatorid[j],
        On::Tendon(t) => m.tendon_actuatorid[t],
    };
    match id {
        -1 => 0..0,
        // Several actuators: the callers search all of them.
        -2 => 0..m.nactuator,
        i => i as usize..i as usize + 1,
    }
}

fn acts(m: &Model, i: usize, on: On) -> bool {
    let (id, _) = target(m, i);
    match m.actuator_trntype[i] {
        trntype::JOINT | trntype::JOINTINPARENT => on == On::Joint(id),
        trntype::TENDON => on == On::Tendon(id),
        _ => false,
    }
}

/// The squared gear ratio g² of actuator `i`.
fn square(m: &Model, i: usize) -> f64 {
    let gear = m.actuator_gear[6 * m.actuator_outadr[i] as usize];
    gear * gear
}

/// Reflected inertia of all actuators on a joint or tendon, kg or kg m².
pub(crate) fn armature(m: &Model, on: On) -> f64 {
    let mut sum = 0.0;
    for i in actuators(m, on) {
        if acts(m, i, on) {
            sum += m.actuator_armature[i] * square(m, i);
        }
    }
    sum
}

/// Reflected damping of all actuators on a joint or tendon: the linear coefficient and the two polynomial ones.
pub(crate) fn damping(m: &Model, on: On) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for i in actuators(m, on) {
        if acts(m, i, on) {
            let coefficients =
                [m.actuator_damping[i], m.actuator_dampingpoly[2 * i], m.actuator_dampingpoly[2 * i + 1]];
            sum = crate::math::add_scaled(sum, coefficients, square(m, i));
        }
    }
    sum
}

/// The inertia of tendon `t`, including that of actuators, kg.
pub(crate) fn tendon_inertia(m: &Model, t: usize) -> f64 {
    m.tendon_armature[t] + armature(m, On::Tendon(t))
}

/// Whether any tendon has inertia, by itself or from an actuator. Such a tendon couples trees.
pub(crate) fn tendons_have_inertia(m: &Model) -> bool {
    (0..m.ntendon).any(|t| tendon_inertia(m, t) != 0.0)
}
