//! Activations: how fast they change, and their values at the end of a step.
//!
//! First-order dynamics of MuJoCo's documentation, "Computation: Activation dynamics". Filters may be integrated
//! exactly: for a constant input, a(h) = a + ȧ τ (1 - exp(-h/τ)).

use super::{integrates, motor, muscle, prm, servo, states, switched_off};
use crate::math::*;
use crate::{Data, Model, disable, dyntype, gaintype};

/// `act_dot` of actuator `i`. A motor that limits how fast its setpoint moves writes the limited one to `ctrl`.
pub(super) fn rates(m: &Model, d: &mut Data, i: usize, ctrl: &mut [f64]) {
    let states = states(m, i);
    let Some(last) = states.clone().last() else { return };
    let u = m.actuator_ctrladr[i] as usize;
    let p = prm(&m.actuator_dynprm, i);
    match m.actuator_dyntype[i] {
        dyntype::INTEGRATOR => {
            for (at, k) in states.zip(u..) {
                d.act_dot[at] = ctrl[k];
            }
        }
        dyntype::FILTER | dyntype::FILTEREXACT => {
            d.act_dot[last] = (ctrl[u] - d.act[last]) / p[0].max(MINVAL);
        }
        dyntype::MUSCLE => d.act_dot[last] = muscle::rate(p, ctrl[u], d.act[last]),
        dyntype::PID => servo::rates(m, d, i, ctrl),
        dyntype::DCMOTOR => motor::rates(m, d, i, ctrl),
        _ => {}
    }
}

/// The value of activation `at` that acts in this step: that of the end of the step where `actearly` says so.
pub(super) fn acting(m: &Model, d: &Data, i: usize, at: usize) -> f64 {
    if m.actuator_actearly[i] { next(m, d, i, at, d.act_dot[at]) } else { d.act[at] }
}

/// Activation `at` of actuator `i` at the end of the step.
fn next(m: &Model, d: &Data, i: usize, at: usize, rate: f64) -> f64 {
    let h = m.opt.timestep;
    let act = d.act[at];
    let value = match m.actuator_dyntype[i] {
        dyntype::DCMOTOR => return motor::next(m, d, i, at, rate),
        dyntype::FILTEREXACT => exact(act, rate, m.actuator_dynprm[10 * i], h),
        _ => act + rate * h,
    };
    if m.actuator_actlimited[i] { clip(value, rows::<2>(&m.actuator_actrange)[i]) } else { value }
}

/// A filter with time constant τ after a time h.
pub(super) fn exact(act: f64, rate: f64, tau: f64, h: f64) -> f64 {
    let tau = tau.max(MINVAL);
    act + rate * tau * (1.0 - libm::exp(-h / tau))
}

/// Advances `act` by a step along `act_dot`.
pub(crate) fn advance(m: &Model, d: &mut Data) {
    if m.opt.disabled(disable::ACTUATION) {
        return;
    }
    for i in 0..m.nactuator {
        let off = switched_off(m, i);
        for at in states(m, i) {
            d.act[at] = next(m, d, i, at, if off { 0.0 } else { d.act_dot[at] });
        }
        if integrates(m, i) {
            anchor(m, d, i);
        }
    }
}

/// Keeps an integrated setpoint that is an angle within a turn.
fn anchor(m: &Model, d: &mut Data, i: usize) {
    let states = states(m, i);
    if m.actuator_gaintype[i] == gaintype::SO3 {
        let turn = 2.0 * std::f64::consts::PI;
        let act = &mut d.act[states];
        let angle = act.iter().map(|a| a * a).sum::<f64>().sqrt();
        if angle > std::f64::consts::PI {
            let scale = (angle - turn * (angle / turn).round()) / angle;
            act.iter_mut().for_each(|a| *a *= scale);
        }
    } else if let Some(last) = states.last() {
        d.act[last] = servo::wrapped(m, d, i, d.act[last]);
    }
}
