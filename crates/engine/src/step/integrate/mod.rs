//! Integrators: they compute the next state from the accelerations.

mod adaptive;
mod euler;
mod explicit;
mod flow;
mod gauss;
mod implicit;
mod position;
mod runge_kutta;

use super::{forward, sleep};
use crate::forces::actuation;
use crate::kinds::integrator;
use crate::math::{combine, copy};
use crate::model::stage::Stage;
use crate::model::{Fields, Model, asleep};
use crate::step::workspace::StepScratch;
use crate::{constraint, sensor};

pub use position::{differentiate_pos, integrate_pos};

/// Computes the next state with the integrator of the options.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn integrate(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    match m.opt.integrator {
        integrator::EULER => euler::euler(m, d, s),
        _ => by_another(m, d, s),
    }
}

#[cfg_attr(not(feature = "small"), inline(never))]
fn by_another(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    match m.opt.integrator {
        integrator::RK4 => runge_kutta::rk4(m, d, s),
        integrator::RKMK4 => explicit::explicit(m, d, s, &explicit::FOURTH),
        integrator::RKMK8 => explicit::explicit(m, d, s, &explicit::EIGHTH),
        integrator::GAUSS => gauss::gauss(m, d, s),
        integrator::ADAPTIVE => adaptive::adaptive(m, d, s),
        _ => integrate_once(m, d, s),
    }
}

/// Like [`integrate`], with a single evaluation of the forces. Methods that need more evaluations, such as Runge–Kutta, become
/// Euler.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn integrate_once(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    match m.opt.integrator {
        integrator::IMPLICIT => implicit::implicit(m, d, s),
        integrator::IMPLICITFAST => implicit::implicitfast(m, d, s),
        // The acceleration already belongs to the end of the step.
        integrator::DISCRETE => advance(m, d, s, RateOverrides::default()),
        _ => euler::euler(m, d, s),
    }
}

/// Replacements for the rates that an integrator uses. `None` means the field of the data.
#[derive(Default)]
struct RateOverrides<'a> {
    activation: Option<&'a mut Vec<f64>>,
    /// Activations at the end of the step, if they are known.
    reached: Option<&'a [f64]>,
    acceleration: Option<&'a [f64]>,
    velocity: Option<&'a [f64]>,
}

/// The last part of every integrator, in MuJoCo's order: histories, activations, sleep, velocities, positions with the
/// new velocities, time, and the acceleration that warm-starts the next solver.
#[cfg_attr(not(feature = "small"), inline(always))]
fn advance(m: &Model, d: &mut Fields, s: &mut StepScratch, slopes: RateOverrides) {
    let h = m.opt.timestep;
    let RateOverrides { activation, reached, acceleration, velocity } = slopes;
    if m.nhistory > 0 {
        record(m, d, s);
    }
    match (activation, reached) {
        _ if m.na == 0 => {}
        (Some(rates), _) => {
            std::mem::swap(&mut d.act_dot, rates);
            actuation::advance(m, d);
            std::mem::swap(&mut d.act_dot, rates);
        }
        (_, Some(values)) => actuation::arrive(m, d, values),
        _ => actuation::advance(m, d),
    }
    if d.plan.keeps(Stage::Sleep) && asleep::on(m, d) {
        advance_awake(m, d, s, acceleration, velocity);
    } else {
        combine(&mut d.qvel, [acceleration.unwrap_or(&d.qacc)], |v, [a]| v + h * a);
        integrate_pos(m, &mut d.qpos, velocity.unwrap_or(&d.qvel), h);
    }
    d.time += h;
    copy(&d.qacc, &mut d.qacc_warmstart);
}

/// Like [`advance`], with the acceleration that an implicit method has stored in the scratch.
#[cfg_attr(not(feature = "small"), inline(always))]
fn advance_along(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    let acceleration = std::mem::take(&mut s.damping.qacc);
    advance(m, d, s, RateOverrides { acceleration: Some(&acceleration), ..RateOverrides::default() });
    s.damping.qacc = acceleration;
}

/// Computes velocities and positions if trees may sleep. Trees that fall asleep stop, and the fields that depend on their
/// velocities are computed again. The positions of sleeping trees do not change.
#[cfg_attr(not(feature = "small"), inline(never))]
fn advance_awake(
    m: &Model,
    d: &mut Fields,
    s: &mut StepScratch,
    acceleration: Option<&[f64]>,
    velocity: Option<&[f64]>,
) {
    let (mut a, mut start) = (std::mem::take(&mut s.sleep.acceleration), std::mem::take(&mut s.sleep.start));
    a.copy_from_slice(acceleration.unwrap_or(&d.qacc));
    if sleep::fall_asleep(m, d, &s.constraint.islands) {
        if m.opt.integrator == integrator::DISCRETE {
            // The constraint rows of the discrete integrator belong to the end of the step, so they are made again.
            constraint::make(m, d, &mut s.constraint);
        }
        forward::from_velocities(m, d, s);
        sleep::update(m, d);
    }
    if m.opt.integrator == integrator::DISCRETE {
        // The acceleration is that of the data, which may have been computed again.
        a.copy_from_slice(&d.qacc);
    }
    start.copy_from_slice(&d.qpos);
    for (v, a) in d.qvel.iter_mut().zip(&a) {
        *v += m.opt.timestep * a;
    }
    integrate_pos(m, &mut d.qpos, velocity.unwrap_or(&d.qvel), m.opt.timestep);
    sleep::freeze_sleeping_trees(m, d, &start);
    (s.sleep.acceleration, s.sleep.start) = (a, start);
}

/// Stores the current controls and sensor values for delayed actuators and sensors.
#[cfg_attr(not(feature = "small"), inline(never))]
fn record(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    actuation::record(m, d);
    if d.plan.keeps(Stage::Sensors) {
        sensor::record(m, d, &mut s.sensor);
    }
}
