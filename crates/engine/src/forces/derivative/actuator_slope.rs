//! The derivative of actuator forces with respect to their velocity.

use crate::forces::actuation::{self, motor, muscle, prm};
use crate::kinds::{biastype, disable, gaintype};
use crate::math::*;
use crate::model::{Fields, Model};

use super::sparse;

/// `out` ← the derivative of the force of each actuator with respect to its velocity. Returns whether any of these numbers
/// changed.
pub(super) fn find(m: &Model, d: &Fields, out: &mut [f64]) -> bool {
    let on = !m.opt.disabled(disable::ACTUATION);
    let mut others = false;
    for (i, slope) in out.iter_mut().enumerate() {
        let current = if on && acts(m, d, i) { slopes(m, d, i).velocity } else { 0.0 };
        others |= current.to_bits() != slope.to_bits();
        *slope = current;
    }
    others
}

/// Adds the derivative of `qfrc_actuator` with respect to `qvel`, for these derivatives of the actuators.
pub(super) fn add_velocity(m: &Model, d: &Fields, slopes: &[f64], out: &mut [f64]) {
    for (i, &slope) in slopes.iter().enumerate().filter(|(_, slope)| **slope != 0.0) {
        for (dofs, moment) in moments(m, d, i) {
            sparse::add_outer(m, dofs, moment, slope, out);
        }
    }
}

/// The moments of an actuator, one for each of its force outputs: degrees of freedom and values.
pub(crate) fn moments<'a>(
    m: &Model,
    d: &'a Fields,
    i: usize,
) -> impl Iterator<Item = (&'a [i32], &'a [f64])> + use<'a> {
    let first = m.actuator_outadr[i] as usize;
    (first..first + m.actuator_outnum[i] as usize).map(|o| {
        let row = d.moment_rowadr[o] as usize..(d.moment_rowadr[o] + d.moment_rownnz[o]) as usize;
        (&d.moment_colind[row.clone()], &d.actuator_moment[row])
    })
}

/// Whether the force of an actuator follows its law: its group is enabled, and its force is not at a limit.
pub(crate) fn acts(m: &Model, d: &Fields, i: usize) -> bool {
    if actuation::switched_off(m, i) {
        return false;
    }
    if !m.actuator_forcelimited[i] {
        return true;
    }
    let [lower, upper] = rows::<2>(&m.actuator_forcerange)[i];
    let first = m.actuator_outadr[i] as usize;
    let force = &d.actuator_force[first..first + m.actuator_outnum[i] as usize];
    match force {
        // The range limits the magnitude of a torque.
        &[x, y, z] => norm([x, y, z]) < upper,
        _ => force.iter().all(|&f| f > lower && f < upper),
    }
}

/// ∂force/∂velocity and ∂force/∂length.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ForceDerivatives {
    pub(crate) velocity: f64,
    pub(crate) length: f64,
}

/// The derivatives of the force of an actuator with respect to its length and velocity.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn slopes(m: &Model, d: &Fields, i: usize) -> ForceDerivatives {
    let mut out = match m.actuator_biastype[i] {
        biastype::AFFINE | biastype::SO3 => {
            let [_, length, velocity, ..] = *prm(&m.actuator_biasprm, i);
            ForceDerivatives { velocity, length }
        }
        _ => ForceDerivatives { velocity: 0.0, length: 0.0 },
    };
    // The most common actuators have a force that is proportional to their input. The others need more terms.
    if m.actuator_gaintype[i] != gaintype::FIXED || m.actuator_biastype[i] == biastype::MUSCLE {
        add_other(m, d, i, &mut out);
    }
    out
}

/// Adds the terms of other gains than fixed ones, and of muscles.
#[inline(never)]
fn add_other(m: &Model, d: &Fields, i: usize, out: &mut ForceDerivatives) {
    let (gain, bias) = (prm(&m.actuator_gainprm, i), prm(&m.actuator_biasprm, i));
    match m.actuator_gaintype[i] {
        gaintype::AFFINE => {
            let input = actuation::input(m, d, i, &d.acting);
            out.velocity += gain[2] * input;
            out.length += gain[1] * input;
        }
        gaintype::MUSCLE => {
            let input = actuation::input(m, d, i, &d.acting);
            let state = muscle::MuscleState::new(m, d, m.actuator_outadr[i] as usize, gain);
            out.velocity += muscle::gain_by_velocity(gain, &state) * input;
            out.length += muscle::gain_by_length(gain, &state) * input;
        }
        gaintype::DCMOTOR => {
            let [velocity, length] = motor::slopes(m, d, i, &d.acting);
            out.velocity += velocity;
            out.length += length;
        }
        _ => {}
    }
    if m.actuator_biastype[i] == biastype::MUSCLE {
        let state = muscle::MuscleState::new(m, d, m.actuator_outadr[i] as usize, bias);
        out.length += muscle::bias_by_length(bias, &state);
    }
}
