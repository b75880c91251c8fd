//! Gravity compensation: a force opposite to gravity at the centre of mass of a body.

use crate::dynamics::jacobian;
use crate::kinds::disable;
use crate::math::*;
use crate::model::{Fields, Model};

/// Computes `qfrc_gravcomp`, which must be zero before: -g m c for a body of mass m with compensation c. Returns whether it acts.
pub(super) fn gravcomp(m: &Model, d: &mut Fields) -> bool {
    let gravity = m.opt.gravity;
    if m.ngravcomp == 0 || m.opt.disabled(disable::GRAVITY) || norm(gravity) == 0.0 {
        return false;
    }
    let mut out = std::mem::take(&mut d.qfrc_gravcomp);
    for b in 1..m.nbody {
        if m.body_gravcomp[b] != 0.0 {
            let force = scale(gravity, -m.body_mass[b] * m.body_gravcomp[b]);
            jacobian::apply(m, d, b, rows::<3>(&d.xipos)[b], force, [0.0; 3], &mut out);
        }
    }
    d.qfrc_gravcomp = out;
    true
}
