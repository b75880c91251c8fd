//! How the force of an actuator changes with its velocity.

use crate::math::*;
use crate::{Data, Model, biastype, disable, dyntype, gaintype};

use super::sparse;

/// Numbers of an actuator in `actuator_gainprm`, `actuator_biasprm` and `actuator_dynprm`.
const PARAMETERS: usize = 10;

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
    let group = m.actuator_group[i];
    if (0..31).contains(&group) && m.opt.disableactuator & (1 << group) != 0 {
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
    let prm = |of: &[f64]| rows::<PARAMETERS>(of)[i];
    let (dynamics, gain, bias) =
        (prm(&m.actuator_dynprm), prm(&m.actuator_gainprm), prm(&m.actuator_biasprm));
    let mut slope = match m.actuator_biastype[i] {
        biastype::AFFINE | biastype::SO3 => bias[2],
        biastype::DCMOTOR if dynamics[0] <= 0.0 => -gain[1] * gain[1] / gain[0].max(MINVAL),
        _ => 0.0,
    };
    match m.actuator_gaintype[i] {
        gaintype::AFFINE => slope += gain[2] * input(m, d, i),
        gaintype::MUSCLE => slope += muscle_slope(m, d, i, &gain) * input(m, d, i),
        gaintype::DCMOTOR => slope += motor_slope(m.opt.timestep, &dynamics, &gain),
        _ => {}
    }
    slope
}

/// ∂force/∂length.
pub(crate) fn length_slope(m: &Model, d: &Data, i: usize) -> f64 {
    let prm = |of: &[f64]| rows::<PARAMETERS>(of)[i];
    let (gain, bias) = (prm(&m.actuator_gainprm), prm(&m.actuator_biasprm));
    let mut slope = match m.actuator_biastype[i] {
        biastype::AFFINE | biastype::SO3 => bias[1],
        _ => 0.0,
    };
    if m.actuator_gaintype[i] == gaintype::AFFINE {
        slope += gain[1] * input(m, d, i);
    }
    slope
}

/// What the gain multiplies: the control, or the last activation.
fn input(m: &Model, d: &Data, i: usize) -> f64 {
    if m.actuator_dyntype[i] == dyntype::NONE || m.actuator_actnum[i] == 0 {
        return d.ctrl[m.actuator_ctrladr[i] as usize];
    }
    let last = (m.actuator_actadr[i] + m.actuator_actnum[i] - 1) as usize;
    if m.actuator_actearly[i] {
        crate::integrate::activation::next(m, i, d.act[last], d.act_dot[last], m.opt.timestep)
    } else {
        d.act[last]
    }
}

/// A motor's voltage U drives the torque K U/R, against friction in its bristles. The voltage of a position
/// controller falls by kd with the velocity, that of a velocity controller by kp; the current follows with the time
/// constant of the coil.
fn motor_slope(h: f64, dynamics: &[f64; PARAMETERS], gain: &[f64; PARAMETERS]) -> f64 {
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

/// The derivative of a muscle's gain F₀ FL FV with respect to velocity: that of the force–velocity curve.
fn muscle_slope(m: &Model, d: &Data, i: usize, prm: &[f64; PARAMETERS]) -> f64 {
    let &[r0, r1, force, scale, lmin, lmax, vmax, _, fvmax, _] = prm;
    let out = m.actuator_outadr[i] as usize;
    let [low, high] = rows::<2>(&m.actuator_lengthrange)[out];
    let peak = if force < 0.0 { scale / m.actuator_acc0[out].max(MINVAL) } else { force };
    let optimum = (high - low) / (r1 - r0).max(MINVAL);
    let length = r0 + (d.actuator_length[out] - low) / optimum.max(MINVAL);
    let fastest = (optimum * vmax).max(MINVAL);
    let velocity = d.actuator_velocity[out] / fastest;
    let y = fvmax - 1.0;
    let slope = if velocity <= -1.0 || velocity > y {
        0.0
    } else if velocity <= 0.0 {
        2.0 * (velocity + 1.0)
    } else {
        2.0 * (y - velocity) / y.max(MINVAL)
    };
    -peak * force_length(length, lmin, lmax) * slope / fastest
}

/// Active force over length: two parabolas from 0 to 1, two back to 0.
fn force_length(length: f64, lmin: f64, lmax: f64) -> f64 {
    let (a, b) = (0.5 * (lmin + 1.0), 0.5 * (1.0 + lmax));
    let half = |x: f64, span: f64| 0.5 * (x / span.max(MINVAL)) * (x / span.max(MINVAL));
    if length < lmin || length > lmax {
        0.0
    } else if length <= a {
        half(length - lmin, a - lmin)
    } else if length <= 1.0 {
        1.0 - half(1.0 - length, 1.0 - a)
    } else if length <= b {
        1.0 - half(length - 1.0, b - 1.0)
    } else {
        half(lmax - length, lmax - b)
    }
}
