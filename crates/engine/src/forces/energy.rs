//! Potential and kinetic energy, if the energy flag is set.

use crate::dynamics::mass;
use crate::forces::passive::spring;
use crate::kinds::disable;
use crate::math::*;
use crate::model::{Fields, Model};

/// `energy[0]`: the potential energy of gravity and springs, J. That of gravity is zero if every centre of mass is at the origin.
pub fn potential(m: &Model, d: &mut Fields) {
    let mut e = 0.0;
    if !m.opt.disabled(disable::GRAVITY) {
        let xipos = rows::<3>(&d.xipos);
        for i in 1..m.nbody {
            e -= m.body_mass[i] * dot(m.opt.gravity, xipos[i]);
        }
    }
    if !m.opt.disabled(disable::SPRING) {
        e += spring::energy(m, d);
    }
    d.energy[0] = e;
}

/// `energy[1]` = ½ vᵀ M v, J.
pub fn kinetic(m: &Model, d: &mut Fields) {
    d.energy[1] = 0.5 * mass::quadratic(m, &d.M, &d.qvel);
}
