//! Integrators: from accelerations to the next state.

pub(crate) mod discrete;
mod euler;
mod implicit;
mod position;
mod runge_kutta;

use crate::forces::actuation;
use crate::math::{combine, copy};
use crate::model::reflect::Stage;
use crate::step::sleep;
use crate::{Data, Model, integrator, sensor};

pub(crate) use discrete::Metric;
pub(crate) use euler::{accelerate, damps, has_dampers};
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
        integrator::DISCRETE => advance(m, d, Slopes::default()),
        _ => euler::euler(m, d),
    }
}

/// What an integrator advances along, where that is not what the data hold.
#[derive(Default)]
struct Slopes<'a> {
    activation: Option<&'a mut Vec<f64>>,
    acceleration: Option<&'a [f64]>,
    velocity: Option<&'a [f64]>,
}

/// What every integrator ends with, in MuJoCo's order: histories, activations, sleep, velocities, positions along the
/// new velocities, time, and the acceleration from which the next solver starts.
#[inline(always)]
fn advance(m: &Model, d: &mut Data, slopes: Slopes) {
    let h = m.opt.timestep;
    let Slopes { activation, acceleration, velocity } = slopes;
    if m.nhistory > 0 {
        record(m, d);
    }
    match activation {
        _ if m.na == 0 => {}
        Some(rates) => {
            std::mem::swap(&mut d.act_dot, rates);
            actuation::advance(m, d);
            std::mem::swap(&mut d.act_dot, rates);
        }
        None => actuation::advance(m, d),
    }
    if d.plan.keeps(Stage::Sleep) && sleep::on(m, d) {
        sleep::advance(m, d, acceleration, velocity);
    } else {
        combine(&mut d.qvel, [acceleration.unwrap_or(&d.qacc)], |v, [a]| v + h * a);
        integrate_pos(m, &mut d.qpos, velocity.unwrap_or(&d.qvel), h);
    }
    d.time += h;
    copy(&d.qacc, &mut d.qacc_warmstart);
}

/// Keeps the controls and values of this time for delayed actuators and sensors.
fn record(m: &Model, d: &mut Data) {
    actuation::record(m, d);
    if d.plan.keeps(Stage::Sensors) {
        sensor::record(m, d);
    }
}
