//! What a scene holds: the energy of motion, of gravity, and of what is elastic, servos included.

use super::forward;
use super::workspace::Scratch;
use crate::dynamics::mass;
use crate::forces::passive::spring;
use crate::forces::{actuation, transmission};
use crate::kinds::disable;
use crate::math::*;
use crate::model::{Fields, Model};

/// Mechanical energy, J.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Energy {
    /// ½ vᵀ M v.
    pub kinetic: f64,
    /// Of gravity.
    pub gravity: f64,
    /// Of springs, and of actuators whose force follows from their length.
    pub elastic: f64,
}

impl Energy {
    /// What gravity and elastic things hold, J.
    pub fn potential(&self) -> f64 {
        self.gravity + self.elastic
    }
}

/// The energy at `qpos` and `qvel`, for the controls at hand. `None` where some actuator has no potential: it may feed the
/// scene. Computes where things are, how long they are and how heavy, and nothing else.
pub fn mechanical_energy(m: &Model, d: &mut Fields, s: &mut Scratch) -> Option<Energy> {
    forward::placed(m, d, s);
    transmission::transmissions(m, d, &mut s.forces);
    let mut gravity = 0.0;
    if !m.opt.disabled(disable::GRAVITY) {
        for (b, &x) in rows::<3>(&d.xipos).iter().enumerate().skip(1) {
            gravity -= m.body_mass[b] * (1.0 - m.body_gravcomp[b]) * dot(m.opt.gravity, x);
        }
    }
    let springs = if m.opt.disabled(disable::SPRING) { 0.0 } else { spring::energy(m, d) };
    let elastic = springs + servos(m, d)?;
    Some(Energy { kinetic: 0.5 * mass::quadratic(m, &d.M, &d.qvel), gravity, elastic })
}

/// The potential of all actuators; `None` where one of them has none.
///
/// A force clip(u) with u = a - k x has the potential Φ(u)/k, where Φ' = clip: a parabola with its tangents beyond the limits.
/// With k = 0 the force c is constant: -c x.
fn servos(m: &Model, d: &mut Fields) -> Option<f64> {
    if m.nactuator == 0 || m.opt.disabled(disable::ACTUATION) {
        return Some(0.0);
    }
    let mut sum = 0.0;
    actuation::controls(m, d);
    for i in (0..m.nactuator).filter(|&i| !actuation::switched_off(m, i)) {
        if actuation::idle(m, d, i) {
            continue;
        }
        let [u, k] = actuation::along_length(m, d, i)?;
        let c = if m.actuator_forcelimited[i] { clip(u, rows::<2>(&m.actuator_forcerange)[i]) } else { u };
        let length = d.actuator_length[m.actuator_outadr[i] as usize];
        sum += if k != 0.0 { c * (u - 0.5 * c) / k } else { -c * length };
    }
    Some(sum)
}
