//! Potential and kinetic energy, when the energy flag asks for them.

use crate::math::*;
use crate::{Data, Model, disable, joint, mass};

/// `energy[0]`: gravity and joint springs, J. Zero where every centre of mass is at the origin.
pub(crate) fn potential(m: &Model, d: &mut Data) {
    let mut e = 0.0;
    if !m.opt.disabled(disable::GRAVITY) {
        let xipos = rows::<3>(&d.xipos);
        for i in 1..m.nbody {
            e -= m.body_mass[i] * dot(m.opt.gravity, xipos[i]);
        }
    }
    if !m.opt.disabled(disable::SPRING) {
        for j in 0..m.njnt {
            let k = m.jnt_stiffness[j];
            if k == 0.0 {
                continue;
            }
            let mut q = m.jnt_qposadr[j] as usize;
            let kind = m.jnt_type[j];
            if kind == joint::SLIDE || kind == joint::HINGE {
                let x = d.qpos[q] - m.qpos_spring[q];
                e += 0.5 * k * x * x;
                continue;
            }
            if kind == joint::FREE {
                for i in 0..3 {
                    let x = d.qpos[q + i] - m.qpos_spring[q + i];
                    e += 0.5 * k * x * x;
                }
                q += 3;
            }
            let turn = crate::passive::ball_displacement(&d.qpos[q..], &m.qpos_spring[q..]);
            e += 0.5 * k * dot(turn, turn);
        }
    }
    d.energy[0] = e;
}

/// `energy[1]` = ½ vᵀ M v, J.
pub(crate) fn kinetic(m: &Model, d: &mut Data) {
    mass::mul(m, &d.M, &d.qvel, &mut d.work.mv, 0..m.nv);
    d.energy[1] = 0.5 * dot_slice(&d.work.mv, &d.qvel);
}
