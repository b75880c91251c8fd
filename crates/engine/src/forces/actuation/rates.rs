//! Time derivatives of activations: the first-order dynamics of MuJoCo's documentation, "Computation: Activation dynamics".

use super::activation::{next, within};
use super::{integrates, motor, muscle, prm, servo, states, switched_off};
use crate::kinds::{disable, dyntype, gaintype};
use crate::math::*;
use crate::model::{Fields, Model};

/// Computes `act_dot` of actuator `i`. A motor with a slew rate limit writes its limited setpoint to `ctrl`.
pub(super) fn rates(m: &Model, d: &mut Fields, i: usize, ctrl: &mut [f64]) {
    let states = states(m, i);
    let Some(last) = states.clone().last() else { return };
    let u = m.actuator_ctrladr[i] as usize;
    let p = prm(&m.actuator_dynprm, i);
    match m.actuator_dyntype[i] {
        dyntype::INTEGRATOR => {
            for (index, k) in states.zip(u..) {
                d.act_dot[index] = ctrl[k];
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

/// Advances `act` by a step with `act_dot`.
#[cfg_attr(not(feature = "small"), inline(never))]
pub(crate) fn advance(m: &Model, d: &mut Fields) {
    if m.opt.disabled(disable::ACTUATION) {
        return;
    }
    for i in 0..m.nactuator {
        let off = switched_off(m, i);
        for index in states(m, i) {
            d.act[index] = next(m, d, i, index, if off { 0.0 } else { d.act_dot[index] });
        }
        if integrates(m, i) {
            anchor(m, d, i);
        }
    }
}

/// Sets `act` to its values at the end of a step, within its limits.
pub(crate) fn arrive(m: &Model, d: &mut Fields, values: &[f64]) {
    if m.opt.disabled(disable::ACTUATION) {
        return;
    }
    for i in (0..m.nactuator).filter(|&i| !switched_off(m, i)) {
        for index in states(m, i) {
            d.act[index] = within(m, d, i, index, values[index]);
        }
        if integrates(m, i) {
            anchor(m, d, i);
        }
    }
}

/// Wraps an integrated setpoint that is an angle to one turn.
fn anchor(m: &Model, d: &mut Fields, i: usize) {
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
