//! Passive forces: joint springs and dampers.

use crate::math::*;
use crate::{Data, Model, disable, joint};

/// `qfrc_spring`, `qfrc_damper`, `qfrc_passive`.
pub(crate) fn passive(m: &Model, d: &mut Data) {
    d.qfrc_spring.fill(0.0);
    d.qfrc_damper.fill(0.0);
    if !m.opt.disabled(disable::SPRING) {
        springs(m, d);
    }
    if !m.opt.disabled(disable::DAMPER) {
        for i in 0..m.nv {
            // Without a damper the force is 0, not -0: a plan that leaves this stage out finds the same.
            if m.dof_damping[i] != 0.0 {
                d.qfrc_damper[i] = -m.dof_damping[i] * d.qvel[i];
            }
        }
    }
    for i in 0..m.nv {
        d.qfrc_passive[i] = d.qfrc_spring[i] + d.qfrc_damper[i];
    }
}

/// f = -k (q - q_spring); for rotations the difference is the rotation vector, in the body's frame.
fn springs(m: &Model, d: &mut Data) {
    for j in 0..m.njnt {
        let k = m.jnt_stiffness[j];
        if k == 0.0 {
            continue;
        }
        let (q, v) = (m.jnt_qposadr[j] as usize, m.jnt_dofadr[j] as usize);
        match m.jnt_type[j] {
            joint::SLIDE | joint::HINGE => d.qfrc_spring[v] = -k * (d.qpos[q] - m.qpos_spring[q]),
            kind => {
                let (mut q, mut v) = (q, v);
                if kind == joint::FREE {
                    for i in 0..3 {
                        d.qfrc_spring[v + i] = -k * (d.qpos[q + i] - m.qpos_spring[q + i]);
                    }
                    (q, v) = (q + 3, v + 3);
                }
                let turn = ball_displacement(&d.qpos[q..], &m.qpos_spring[q..]);
                for i in 0..3 {
                    d.qfrc_spring[v + i] = -k * turn[i];
                }
            }
        }
    }
}

/// The rotation vector from `reference` to `q`, both quaternions, in the frame of `reference`.
pub(crate) fn ball_displacement(q: &[f64], reference: &[f64]) -> Vec3 {
    let q = quat_normalize([q[0], q[1], q[2], q[3]]);
    let r = [reference[0], reference[1], reference[2], reference[3]];
    quat_to_vel(quat_mul(quat_conj(r), q))
}
