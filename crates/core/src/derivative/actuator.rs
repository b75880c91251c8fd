//! How the force of an actuator changes with its velocity.

use crate::actuation::{self, muscle, prm};
use crate::math::*;
use crate::{Data, Model, biastype, disable, gaintype};

use super::sparse;

/// Adds the derivative of `qfrc_actuator` with respect to `qvel`.
pub(super) fn add_velocity(m: &Model, d: &Data, out: &mut [f64]) {
    if m.opt.disabled(disable::ACTUATION) {
        return;
    }
    for i in (0..m.nactuator).filter(|&i| acts(m, d, i)) {
        let slope = velocity_slope(m, d, i);
        if slope != 0.0 {
            for (dofs, moment) in moments(m, d, i) {
                sparse::add_outer(m, dofs, moment, slope, out);
            }
        }
    }
}

/// The moments of an actuator, one for each of its force outputs: degrees of freedom and values.
pub(crate) fn moments<'a>(
    m: &Model,
    d: &'a Data,
    i: usize,
) -> impl Iterator<Item = (&'a [i32], &'a [f64])> + use<'a> {
    let first = m.actuator_outadr[i] as usize;
    (first..first + m.actuator_outnum[i] as usize).map(|o| {
        let row = d.moment_rowadr[o] as usize..(d.moment_rowadr[o] + d.moment_rownnz[o]) as usize;
        (&d.moment_colind[row.clone()], &d.actuator_moment[row])
    })
}

/// Whether the force of an actuator follows its law: its group is on, and no range holds the force.
pub(crate) fn acts(m: &Model, d: &Data, i: usize) -> bool {
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
        // The range holds the magnitude of a torque.
        &[x, y, z] => norm([x, y, z]) < upper,
        _ => force.iter().all(|&f| f > lower && f < upper),
    }
}

/// ∂force/∂velocity.
pub(crate) fn velocity_slope(m: &Model, d: &Data, i: usize) -> f64 {
    let (dynamics, gain, bias) =
        (prm(&m.actuator_dynprm, i), prm(&m.actuator_gainprm, i), prm(&m.actuator_biasprm, i));
    let mut slope = match m.actuator_biastype[i] {
        biastype::AFFINE | biastype::SO3 => bias[2],
        biastype::DCMOTOR if dynamics[0] <= 0.0 => -gain[1] * gain[1] / gain[0].max(MINVAL),
        _ => 0.0,
    };
    match m.actuator_gaintype[i] {
        gaintype::AFFINE => slope += gain[2] * actuation::input(m, d, i, &d.work.ctrl),
        gaintype::MUSCLE => {
            let state = muscle::State::new(m, d, m.actuator_outadr[i] as usize, gain);
            slope += muscle::gain_slope(gain, &state) * actuation::input(m, d, i, &d.work.ctrl);
        }
        gaintype::DCMOTOR => slope += motor_slope(m.opt.timestep, dynamics, gain),
        _ => {}
    }
    slope
}

/// ∂force/∂length.
pub(crate) fn length_slope(m: &Model, d: &Data, i: usize) -> f64 {
    let (gain, bias) = (prm(&m.actuator_gainprm, i), prm(&m.actuator_biasprm, i));
    let mut slope = match m.actuator_biastype[i] {
        biastype::AFFINE | biastype::SO3 => bias[1],
        _ => 0.0,
    };
    if m.actuator_gaintype[i] == gaintype::AFFINE {
        slope += gain[1] * actuation::input(m, d, i, &d.work.ctrl);
    }
    slope
}

/// A motor's voltage U drives the torque K U/R, against friction in its bristles. The voltage of a position
/// controller falls by kd with the velocity, that of a velocity controller by kp; the current follows with the time
/// constant of the coil.
fn motor_slope(h: f64, dynamics: &[f64; 10], gain: &[f64; 10]) -> f64 {
    let (resistance, constant) = (gain[0].max(MINVAL), gain[1]);
    let voltage = match gain[8] as i32 {
        1 => -gain[6],
        2 => -gain[4],
        _ => 0.0,
    };
    let coil = dynamics[0];
    let driven = if coil > 0.0 {
        constant * (voltage - constant) * (1.0 - libm::exp(-h / coil)) / resistance
    } else {
        constant * voltage / resistance
    };
    driven - dynamics[6].max(0.0)
}
