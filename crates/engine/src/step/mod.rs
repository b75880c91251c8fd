//! A step: the stages in their order, the plan of the stages that a scene needs, and the integration of the accelerations.
//!
//! [`forward`] runs the stages in their order. An integrator computes the next state from their results. Bad numbers are detected
//! before and between.

mod access;
pub mod analysis;
pub mod balance;
mod calls;
mod clocked;
pub(crate) mod damping;
pub mod deciding;
pub(crate) mod discrete;
pub(crate) mod factored;
pub mod forward;
mod idle;
pub mod integrate;
pub mod inverse;
mod metric;
pub(crate) mod pipeline;
pub(crate) mod planner;
pub mod reset;
pub mod save;
mod sequence;
pub(crate) mod sleep;
pub(crate) mod stages;
pub mod store;
pub mod validate;
pub mod workspace;

use crate::kinds::disable;
use crate::math::{LARGEST, SMALL, bad};
use crate::model::{Fields, Model, Warning, WarningStat};
use crate::step::workspace::StepScratch;
use wide::f64x4;

/// Advances the simulation by one step (`mj_step`).
///
/// A bad number in the state resets the data before the step. A bad number in the acceleration resets the data, and the same step
/// then starts from the reset state. `warning` records the kind of bad number and when it occurred.
pub fn step(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    check_state(m, d, s);
    forward::from_state(m, d, s);
    forward::from_inputs(m, d, s);
    check_acceleration(m, d, s);
    integrate::integrate(m, d, s);
}

/// The first part of a step (`mj_step1`): everything that does not depend on inputs. Controls and applied forces may be
/// set between the two parts.
pub fn step1(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    check_state(m, d, s);
    forward::from_state(m, d, s);
}

/// The second part of a step (`mj_step2`): forces, accelerations, the next state. Runge–Kutta methods need forces at other
/// states; if the options name one, this function makes a semi-implicit Euler step.
pub fn step2(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    forward::from_inputs(m, d, s);
    check_acceleration(m, d, s);
    integrate::integrate_once(m, d, s);
}

/// Whether no number is [`bad`]. Tests four at a time; the last four may overlap the previous ones.
#[cfg_attr(not(feature = "small"), inline(always))]
fn none_bad(v: &[f64]) -> bool {
    let good = |x: &[f64; 4]| f64x4::new(*x).abs().simd_le(f64x4::splat(LARGEST));
    match (v.split_first_chunk(), v.last_chunk()) {
        (Some((first, rest)), Some(last)) if !SMALL => {
            rest.as_chunks().0.iter().fold(good(first) & good(last), |all, x| all & good(x)).all()
        }
        _ => !v.iter().any(|&x| bad(x)),
    }
}

/// Warns about the first bad number, and resets the data unless automatic resets are disabled. The warning is kept after the
/// reset.
#[cold]
#[inline(never)]
fn reset_after(
    m: &Model,
    d: &mut Fields,
    s: &mut StepScratch,
    warning: Warning,
    field: fn(&Fields) -> &[f64],
) -> bool {
    let Some(info) = field(d).iter().position(|&x| bad(x)) else { return false };
    d.warn(warning, info);
    if m.opt.disabled(disable::AUTORESET) {
        // MuJoCo counts a warning twice if it does not reset.
        d.warn(warning, info);
        return false;
    }
    let stat = d.warning[warning as usize];
    reset::reset_data(m, d, s);
    d.warning[warning as usize] = WarningStat { number: 1, ..stat };
    true
}

#[cfg_attr(not(feature = "small"), inline(always))]
fn check_state(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    if !none_bad(&d.qpos) {
        reset_after(m, d, s, Warning::BadQpos, |d| &d.qpos);
    }
    if !none_bad(&d.qvel) {
        reset_after(m, d, s, Warning::BadQvel, |d| &d.qvel);
    }
}

#[cfg_attr(not(feature = "small"), inline(always))]
fn check_acceleration(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    if !none_bad(&d.qacc) && reset_after(m, d, s, Warning::BadQacc, |d| &d.qacc) {
        forward::forward(m, d, s);
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a panic is the report of a failed test
mod tests;
