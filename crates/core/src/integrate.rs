//! Integrators: from accelerations to the next state.
//!
//! Positions live on a manifold (unit quaternions), so they advance along velocities, never by adding
//! coordinates (Hairer, Lubich and Wanner 2006, *Geometric Numerical Integration*, ch. IV).

use crate::math::*;
use crate::pipeline::{self, Skip};
use crate::reflect::Stage;
use crate::{Data, Model, disable, joint, mass, sensor};

/// qpos ← qpos advanced for a time `h` with velocity `v` (`mj_integratePos`).
pub fn integrate_pos(m: &Model, qpos: &mut [f64], v: &[f64], h: f64) {
    for j in 0..m.njnt {
        let (mut q, mut k) = (m.jnt_qposadr[j] as usize, m.jnt_dofadr[j] as usize);
        match m.jnt_type[j] {
            joint::SLIDE | joint::HINGE => qpos[q] += h * v[k],
            kind => {
                if kind == joint::FREE {
                    for i in 0..3 {
                        qpos[q + i] += h * v[k + i];
                    }
                    (q, k) = (q + 3, k + 3);
                }
                let q = &mut qpos[q..q + 4];
                q.copy_from_slice(&quat_integrate([q[0], q[1], q[2], q[3]], [v[k], v[k + 1], v[k + 2]], h));
            }
        }
    }
}

/// Keeps the values of this time for delayed sensors.
fn record(m: &Model, d: &mut Data) {
    if m.nhistory > 0 && d.plan.keeps(Stage::Sensors) {
        sensor::record(m, d);
    }
}

/// Semi-implicit Euler: v += h a, then q advances with the new v. Joint damping is implicit, so that it is
/// stable however stiff: (M + h B) a' = M a.
#[inline(never)]
pub(crate) fn euler(m: &Model, d: &mut Data) {
    let h = m.opt.timestep;
    record(m, d);
    let implicit = d.plan.keeps(Stage::Passive)
        && !m.opt.disabled(disable::EULERDAMP)
        && !m.opt.disabled(disable::DAMPER)
        && m.dof_damping.iter().any(|&b| b != 0.0);
    if implicit {
        let w = &mut d.work;
        w.ld.copy_from_slice(&d.M);
        for i in 0..m.nv {
            w.ld[(m.M_rowadr[i] + m.M_rownnz[i] - 1) as usize] += h * m.dof_damping[i];
        }
        mass::factor(m, &mut w.ld, &mut w.diag_inv);
        for i in 0..m.nv {
            w.qacc[i] = d.qfrc_smooth[i] + d.qfrc_constraint[i];
        }
        mass::solve(m, &w.ld, &w.diag_inv, &mut w.qacc, 0..m.nv);
        for i in 0..m.nv {
            d.qvel[i] += h * d.work.qacc[i];
        }
    } else {
        for (v, a) in d.qvel.iter_mut().zip(&d.qacc) {
            *v += h * a;
        }
    }
    integrate_pos(m, &mut d.qpos, &d.qvel, h);
    d.time += h;
    d.qacc_warmstart.copy_from_slice(&d.qacc);
}

/// The classic Runge–Kutta method of fourth order (Kutta 1901). Stage velocities are averaged and applied in
/// one step on the manifold.
pub(crate) fn rk4(m: &Model, d: &mut Data) {
    // Stage s starts from the first state plus A[s] h times the slope of stage s - 1; B weighs the slopes.
    const A: [f64; 3] = [0.5, 0.5, 1.0];
    const B: [f64; 4] = [1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0];
    let (h, start) = (m.opt.timestep, d.time);
    let mut w = std::mem::take(&mut d.work.rk);
    w.qpos.copy_from_slice(&d.qpos);
    w.qvel.copy_from_slice(&d.qvel);
    w.warmstart.copy_from_slice(&d.qacc);
    for i in 0..m.nv {
        w.dpos[i] = B[0] * d.qvel[i];
        w.dvel[i] = B[0] * d.qacc[i];
    }
    for stage in 0..3 {
        let a = A[stage] * h;
        // The slope of the stage before: its velocity and acceleration.
        w.slope.copy_from_slice(&d.qvel);
        for i in 0..m.nv {
            d.qvel[i] = w.qvel[i] + a * d.qacc[i];
        }
        d.qpos.copy_from_slice(&w.qpos);
        integrate_pos(m, &mut d.qpos, &w.slope, a);
        d.time = start + a;
        pipeline::forward_skip(m, d, Skip::SENSORS);
        for i in 0..m.nv {
            w.dpos[i] += B[stage + 1] * d.qvel[i];
            w.dvel[i] += B[stage + 1] * d.qacc[i];
        }
    }
    d.qpos.copy_from_slice(&w.qpos);
    d.qvel.copy_from_slice(&w.qvel);
    d.time = start;
    record(m, d);
    integrate_pos(m, &mut d.qpos, &w.dpos, h);
    for i in 0..m.nv {
        d.qvel[i] = w.qvel[i] + h * w.dvel[i];
    }
    d.time = start + h;
    // The warm start of the next step is the first stage's acceleration.
    d.qacc_warmstart.copy_from_slice(&w.warmstart);
    d.work.rk = w;
}
