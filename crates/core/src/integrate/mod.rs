//! Integrators: from accelerations to the next state.

pub(crate) mod discrete;
mod euler;
mod implicit;
mod position;
mod runge_kutta;

use crate::reflect::Stage;
use crate::{Data, Model, actuation, integrator, sensor, sleep};

pub(crate) use discrete::Metric;
pub(crate) use euler::{damping, damps};
pub use position::{differentiate_pos, integrate_pos};
pub(crate) use runge_kutta::RungeKutta;

/// The next state, by the integrator that the options name.
pub(crate) fn integrate(m: &Model, d: &mut Data) {
    match m.opt.integrator {
        integrator::RK4 => runge_kutta::rk4(m, d),
        _ => integrate_once(m, d),
    }
}

/// The same from one evaluation of forces: Runge–Kutta, which needs four, becomes Euler.
pub(crate) fn integrate_once(m: &Model, d: &mut Data) {
    match m.opt.integrator {
        integrator::IMPLICIT => implicit::implicit(m, d),
        integrator::IMPLICITFAST => implicit::implicitfast(m, d),
        // Its acceleration is already that of the end of the step.
        integrator::DISCRETE => advance(m, d, None, None),
        _ => euler::euler(m, d),
    }
}

/// What every integrator ends with, in MuJoCo's order: histories, activations, velocities, positions along the new
/// velocities, time, and the acceleration from which the next solver starts. The acceleration and the velocity
/// are those of the data unless others are given.
#[inline(always)]
fn advance(m: &Model, d: &mut Data, acceleration: Option<&[f64]>, velocity: Option<&[f64]>) {
    let h = m.opt.timestep;
    record(m, d);
    actuation::advance(m, d);
    if d.plan.keeps(Stage::Sleep) && sleep::on(m, d) {
        sleep::advance(m, d, acceleration, velocity);
    } else {
        for (v, a) in d.qvel.iter_mut().zip(acceleration.unwrap_or(&d.qacc)) {
            *v += h * a;
        }
        integrate_pos(m, &mut d.qpos, velocity.unwrap_or(&d.qvel), h);
    }
    d.time += h;
    d.qacc_warmstart.copy_from_slice(&d.qacc);
}

/// Keeps the controls and values of this time for delayed actuators and sensors.
fn record(m: &Model, d: &mut Data) {
    if m.nhistory == 0 {
        return;
    }
    actuation::record(m, d);
    if d.plan.keeps(Stage::Sensors) {
        sensor::record(m, d);
    }
}
