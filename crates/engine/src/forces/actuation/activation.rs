//! The values of activations at the end of a step.
//!
//! Filters can be integrated exactly: for a constant input, a(h) = a + ȧ τ (1 - exp(-h/τ)).

use super::{exact, motor};
use crate::kinds::dyntype;
use crate::math::*;
use crate::model::{Fields, Model};

/// The value of activation `index` that is used in this step. With `actearly`, it is that of the end of the step.
pub(super) fn activation_of_step(m: &Model, d: &Fields, i: usize, index: usize) -> f64 {
    if m.actuator_actearly[i] { next(m, d, i, index, d.act_dot[index]) } else { d.act[index] }
}

/// Activation `index` of actuator `i` at the end of the step.
pub(super) fn next(m: &Model, d: &Fields, i: usize, index: usize, rate: f64) -> f64 {
    let h = m.opt.timestep;
    let act = d.act[index];
    let value = match m.actuator_dyntype[i] {
        dyntype::DCMOTOR => return motor::next(m, d, i, index, rate),
        dyntype::FILTEREXACT => exact(act, rate, m.actuator_dynprm[10 * i], h),
        _ => act + rate * h,
    };
    within(m, d, i, index, value)
}

/// A value of activation `index` of actuator `i`, clamped to its limits.
pub(super) fn within(m: &Model, d: &Fields, i: usize, index: usize, value: f64) -> f64 {
    match m.actuator_dyntype[i] {
        dyntype::DCMOTOR => motor::within(m, d, i, index, value),
        _ if m.actuator_actlimited[i] => clip(value, rows::<2>(&m.actuator_actrange)[i]),
        _ => value,
    }
}
