//! Sensors with stored past values: delays, and readings at intervals.
//!
//! At the end of a step, the current value is stored in the buffer of the sensor. A delayed sensor reports the value
//! stored a delay ago; a sensor with an interval reports the last reading. The first slot of the buffer contains the
//! time of the last tick of the interval. Readings follow the ticks as closely as the timesteps allow.

use super::SensorScratch;
use super::table::for_sensor;
use crate::dynamics::subtree;
use crate::forces::history;
use crate::kinds::integrator;
use crate::model::stage::Stage;
use crate::model::{Fields, Model};
use crate::sensor::body_force;

/// The range of the buffer of a sensor, and its number of samples; `None` if it has no buffer.
fn buffer(m: &Model, s: usize) -> Option<(std::ops::Range<usize>, usize)> {
    let n = usize::try_from(m.sensor_history[2 * s]).ok().filter(|&n| n > 0)?;
    let address = usize::try_from(m.sensor_historyadr[s]).ok()?;
    Some((address..address + history::size(n, m.sensor_dim[s] as usize), n))
}

/// Whether a reading is due: at least one interval has passed since the last tick.
fn due(m: &Model, d: &Fields, s: usize, address: usize) -> bool {
    d.history[address] + m.sensor_interval[2 * s] <= d.time
}

/// Writes a past value. Returns `false` if the sensor reports its current reading.
pub(super) fn past(m: &Model, d: &Fields, s: usize, out: &mut [f64]) -> bool {
    let Some((range, n)) = buffer(m, s) else { return false };
    let delay = m.sensor_delay[s];
    let waits = m.sensor_interval[2 * s] > 0.0 && !due(m, d, s, range.start);
    let time = match delay > 0.0 {
        true => d.time - delay,
        false if waits => d.time,
        false => return false,
    };
    history::read(&d.history[range], n, out.len(), time, m.sensor_history[2 * s + 1], out);
    true
}

/// Stores the values of the current time in the buffers, before time advances.
///
/// After a Runge–Kutta step, the poses of bodies are those of the last stage. The stored values are then the same as
/// in MuJoCo: the state at the start of the step, evaluated with the poses and forces of the last stage.
pub(crate) fn record(m: &Model, d: &mut Fields, w: &mut SensorScratch) {
    let delayed = |s: &usize| m.sensor_delay[*s] > 0.0 && m.sensor_history[2 * s] > 0;
    if integrator::many_stages(m.opt.integrator) {
        let needs = |stage| (0..m.nsensor).filter(delayed).any(|s| for_sensor(m, s).needs.contains(&stage));
        if needs(Stage::SubtreeVel) {
            subtree::subtree_vel(m, d);
        }
        if needs(Stage::RnePost) {
            body_force::rne_post_constraint(m, d);
        }
    }
    for s in 0..m.nsensor {
        let Some((range, n)) = buffer(m, s) else { continue };
        if m.sensor_interval[2 * s] > 0.0 {
            if !due(m, d, s, range.start) {
                continue;
            }
            d.history[range.start] += m.sensor_interval[2 * s];
        }
        let dim = m.sensor_dim[s] as usize;
        let mut all = std::mem::take(&mut d.history);
        let value = history::insert(&mut all[range], n, dim, d.time);
        if m.sensor_delay[s] > 0.0 {
            super::read(m, d, w, s, value);
        } else {
            let adr = m.sensor_adr[s] as usize;
            value.copy_from_slice(&d.sensordata[adr..adr + dim]);
        }
        d.history = all;
    }
}

/// Fills the buffers with zeros, at the times before the start at which the sensor would have been read.
pub(crate) fn reset(m: &Model, d: &mut Fields) {
    let h = m.opt.timestep;
    for s in 0..m.nsensor {
        let Some((range, n)) = buffer(m, s) else { continue };
        let [period, phase] = [m.sensor_interval[2 * s], m.sensor_interval[2 * s + 1]];
        let buf = &mut d.history[range];
        if period > 0.0 {
            let tick = if phase == 0.0 { -period } else { phase };
            history::init(buf, n, tick, |i| ((tick - (n - 1 - i) as f64 * period) / h).ceil() * h);
        } else {
            history::init(buf, n, -h, |i| -((n - i) as f64) * h);
        }
    }
}
