//! Activations of actuators, one step later.

use crate::math::MINVAL;
use crate::{Data, Model, dyntype};

/// An activation after a time `h` with the rate `rate`, within its range. A filter that is exact follows its
/// exponential.
pub(crate) fn next(m: &Model, actuator: usize, act: f64, rate: f64, h: f64) -> f64 {
    let next = if m.actuator_dyntype[actuator] == dyntype::FILTEREXACT {
        let tau = m.actuator_dynprm[10 * actuator].max(MINVAL);
        act + rate * tau * (1.0 - libm::exp(-h / tau))
    } else {
        act + rate * h
    };
    if m.actuator_actlimited[actuator] {
        let range = &m.actuator_actrange[2 * actuator..2 * actuator + 2];
        next.max(range[0]).min(range[1])
    } else {
        next
    }
}

/// `act` advances with `act_dot`.
pub(super) fn advance(m: &Model, d: &mut Data) {
    for i in 0..m.nactuator {
        if m.actuator_actadr[i] < 0 {
            continue;
        }
        let first = m.actuator_actadr[i] as usize;
        for a in first..first + m.actuator_actnum[i] as usize {
            d.act[a] = next(m, i, d.act[a], d.act_dot[a], m.opt.timestep);
        }
    }
}
