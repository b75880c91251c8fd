//! Muscles: force over length and velocity, a passive spring, and activation dynamics.
//!
//! The model is in MuJoCo's documentation, "Modeling: Muscles", after Zajac (1989) with the activation dynamics of
//! Millard et al. (2013). Parameters, by place: operating range in optimal lengths (2), peak force, scale of it, lmin,
//! lmax, vmax, fpmax, fvmax.

use crate::math::*;
use crate::model::{Fields, Model};

/// A muscle in normalized units.
pub(crate) struct State {
    /// Peak isometric force, N.
    peak: f64,
    /// Length in optimal lengths.
    length: f64,
    /// Velocity in largest shortening velocities.
    velocity: f64,
    /// The optimal length, m.
    optimal: f64,
    /// The largest shortening velocity, m/s.
    fastest: f64,
}

impl State {
    /// The muscle with output `o` and parameters `p`: its operating range is reached over `actuator_lengthrange`.
    pub(crate) fn new(m: &Model, d: &Fields, o: usize, p: &[f64; 10]) -> State {
        let [shortest, longest] = rows::<2>(&m.actuator_lengthrange)[o];
        let optimal = (longest - shortest) / (p[1] - p[0]).max(MINVAL);
        let peak = if p[2] >= 0.0 { p[2] } else { p[3] / m.actuator_acc0[o].max(MINVAL) };
        let fastest = (optimal * p[6]).max(MINVAL);
        State {
            peak,
            optimal: optimal.max(MINVAL),
            length: p[0] + (d.actuator_length[o] - shortest) / optimal.max(MINVAL),
            velocity: d.actuator_velocity[o] / fastest,
            fastest,
        }
    }
}

/// -F₀ FL(length) FV(velocity): the force of a fully active muscle.
pub(super) fn gain(p: &[f64; 10], s: &State) -> f64 {
    let [_, _, _, _, lmin, lmax, _, _, fvmax, _] = *p;
    -s.peak * over_length(s.length, lmin, lmax) * over_velocity(s.velocity, fvmax)
}

/// Two halves of parabolas up from `lmin` to 1, where it peaks, and two down to `lmax`.
fn over_length(length: f64, lmin: f64, lmax: f64) -> f64 {
    if length < lmin || length > lmax {
        return 0.0;
    }
    let (rise, fall) = (0.5 * (lmin + 1.0), 0.5 * (1.0 + lmax));
    let part = |distance: f64, width: f64| distance / width.max(MINVAL);
    if length <= rise {
        let x = part(length - lmin, rise - lmin);
        0.5 * x * x
    } else if length <= 1.0 {
        let x = part(1.0 - length, 1.0 - rise);
        1.0 - 0.5 * x * x
    } else if length <= fall {
        let x = part(length - 1.0, fall - 1.0);
        1.0 - 0.5 * x * x
    } else {
        let x = part(lmax - length, lmax - fall);
        0.5 * x * x
    }
}

/// From 0 at the largest shortening velocity through 1 at rest to `fvmax`.
fn over_velocity(velocity: f64, fvmax: f64) -> f64 {
    let y = fvmax - 1.0;
    if velocity <= -1.0 {
        0.0
    } else if velocity <= 0.0 {
        (velocity + 1.0) * (velocity + 1.0)
    } else if velocity <= y {
        fvmax - (y - velocity) * (y - velocity) / y.max(MINVAL)
    } else {
        fvmax
    }
}

/// The derivative of the gain with respect to velocity.
pub(crate) fn gain_by_velocity(p: &[f64; 10], s: &State) -> f64 {
    let [_, _, _, _, lmin, lmax, _, _, fvmax, _] = *p;
    let y = fvmax - 1.0;
    let slope = if s.velocity <= -1.0 || s.velocity > y {
        0.0
    } else if s.velocity <= 0.0 {
        2.0 * (s.velocity + 1.0)
    } else {
        2.0 * (y - s.velocity) / y.max(MINVAL)
    };
    -s.peak * over_length(s.length, lmin, lmax) * slope / s.fastest
}

/// The derivative of the gain with respect to length.
pub(crate) fn gain_by_length(p: &[f64; 10], s: &State) -> f64 {
    let [_, _, _, _, lmin, lmax, _, _, fvmax, _] = *p;
    -s.peak * slope_over_length(s.length, lmin, lmax) * over_velocity(s.velocity, fvmax) / s.optimal
}

/// The derivative of [`over_length`].
fn slope_over_length(length: f64, lmin: f64, lmax: f64) -> f64 {
    if length < lmin || length > lmax {
        return 0.0;
    }
    let (rise, fall) = (0.5 * (lmin + 1.0), 0.5 * (1.0 + lmax));
    let part = |distance: f64, width: f64| distance / (width * width).max(MINVAL);
    if length <= rise {
        part(length - lmin, rise - lmin)
    } else if length <= 1.0 {
        part(1.0 - length, 1.0 - rise)
    } else if length <= fall {
        -part(length - 1.0, fall - 1.0)
    } else {
        -part(lmax - length, lmax - fall)
    }
}

/// The derivative of the passive force with respect to length.
pub(crate) fn bias_by_length(p: &[f64; 10], s: &State) -> f64 {
    let (lmax, fpmax) = (p[5], p[7]);
    let width = (0.5 * (1.0 + lmax) - 1.0).max(MINVAL);
    -s.peak * fpmax * ((s.length - 1.0) / width).clamp(0.0, 1.0) / (width * s.optimal)
}

/// The passive force: a parabola from the optimal length to half way to `lmax`, and a line from there.
pub(super) fn bias(p: &[f64; 10], s: &State) -> f64 {
    let (lmax, fpmax) = (p[5], p[7]);
    let half = 0.5 * (1.0 + lmax);
    if s.length <= 1.0 {
        0.0
    } else if s.length <= half {
        let x = (s.length - 1.0) / (half - 1.0).max(MINVAL);
        -s.peak * fpmax * 0.5 * x * x
    } else {
        let x = (s.length - half) / (half - 1.0).max(MINVAL);
        -s.peak * fpmax * (0.5 + x)
    }
}

/// The rate of an activation under a control: a filter whose time constant is longer for activating an active muscle
/// and for deactivating a passive one. Parameters: both time constants, and the width over which one becomes the other.
pub(super) fn rate(p: &[f64; 10], control: f64, act: f64) -> f64 {
    let [activate, deactivate, width, ..] = *p;
    let slow = 0.5 + 1.5 * act.clamp(0.0, 1.0);
    let (activate, deactivate) = (activate * slow, deactivate / slow);
    let error = control.clamp(0.0, 1.0) - act;
    let tau = if width < MINVAL {
        if error > 0.0 { activate } else { deactivate }
    } else {
        deactivate + (activate - deactivate) * sigmoid(error / width + 0.5)
    };
    error / tau.max(MINVAL)
}

/// From 0 to 1 between 0 and 1, twice differentiable: 6x⁵ - 15x⁴ + 10x³.
fn sigmoid(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    x * x * x * (3.0 * x * (2.0 * x - 5.0) + 10.0)
}
