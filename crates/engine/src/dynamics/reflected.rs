//! Inertia and damping that joints and tendons have of the actuators that act on them, and the inertia of tendons.
//!
//! With a gear g a rotor turns g times as fast as what it moves, so that both appear multiplied by g².

use crate::kinds::trntype;
use crate::model::Model;

/// What actuator `i` acts on, and the second site where there is one.
pub fn target(m: &Model, i: usize) -> (usize, Option<usize>) {
    (m.actuator_trnid[2 * i] as usize, usize::try_from(m.actuator_trnid[2 * i + 1]).ok())
}

/// What an actuator adds to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum On {
    Joint(usize),
    Tendon(usize),
}

/// The actuators with inertia or damping of their own on a joint or tendon.
#[cfg_attr(not(feature = "small"), inline(always))]
fn actuators(m: &Model, on: On) -> std::ops::Range<usize> {
    let id = match on {
        On::Joint(j) => m.jnt_actuatorid[j],
        On::Tendon(t) => m.tendon_actuatorid[t],
    };
    match id {
        -1 => 0..0,
        // Several: all are looked at.
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

/// g² of actuator `i`.
fn square(m: &Model, i: usize) -> f64 {
    let gear = m.actuator_gear[6 * m.actuator_outadr[i] as usize];
    gear * gear
}

/// Inertia, kg or kg m².
pub(crate) fn armature(m: &Model, on: On) -> f64 {
    let mut sum = 0.0;
    for i in actuators(m, on) {
        if acts(m, i, on) {
            sum += m.actuator_armature[i] * square(m, i);
        }
    }
    sum
}

/// Damping, and its growth with speed.
pub(crate) fn damping(m: &Model, on: On) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for i in actuators(m, on) {
        if acts(m, i, on) {
            let of =
                [m.actuator_damping[i], m.actuator_dampingpoly[2 * i], m.actuator_dampingpoly[2 * i + 1]];
            sum = crate::math::add_scaled(sum, of, square(m, i));
        }
    }
    sum
}

/// The inertia of tendon `t`, its own and that of actuators, kg.
pub(crate) fn tendon_inertia(m: &Model, t: usize) -> f64 {
    m.tendon_armature[t] + armature(m, On::Tendon(t))
}

/// Whether some tendon has inertia of its own or of an actuator: it ties trees together.
pub(crate) fn tendons_have_inertia(m: &Model) -> bool {
    (0..m.ntendon).any(|t| tendon_inertia(m, t) != 0.0)
}
