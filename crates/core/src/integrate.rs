//! Integrators: from accelerations to the next state.
//!
//! Positions live on a manifold (unit quaternions), so they advance along velocities, never by adding
//! coordinates (Hairer, Lubich and Wanner 2006, *Geometric Numerical Integration*, ch. IV).

use crate::math::*;
use crate::passive::spring;
use crate::pipeline::{self, Skip};
use crate::reflect::Stage;
use crate::{Data, Model, actuation, disable, joint, mass, sensor};

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

/// Semi-implicit Euler: v += h a, then q advances with the new v. Joint damping is implicit, so that it is
/// stable however stiff: (M + h B) a' = M a.
#[inline(never)]
pub(crate) fn euler(m: &Model, d: &mut Data) {
    let h = m.opt.timestep;
    record(m, d);
    actuation::advance(m, d);
    let implicit = d.plan.keeps(Stage::Passive)
        && !m.opt.disabled(disable::EULERDAMP)
        && !m.opt.disabled(disable::DAMPER)
        && (0..m.nv).any(|i| !spring::joint_damper(m, i).is_zero());
    if implicit {
        let w = &mut d.work;
        w.ld.copy_from_slice(&d.M);
        for i in 0..m.nv {
            w.ld[(m.M_rowadr[i] + m.M_rownnz[i] - 1) as usize] +=
                h * spring::joint_damper(m, i).slope(d.qvel[i].abs());
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
    w.act.copy_from_slice(&d.act);
    w.warmstart.copy_from_slice(&d.qacc);
    for i in 0..m.nv {
        w.dpos[i] = B[0] * d.qvel[i];
        w.dvel[i] = B[0] * d.qacc[i];
    }
    for (sum, rate) in w.dact.iter_mut().zip(&d.act_dot) {
        *sum = B[0] * rate;
    }
    for stage in 0..3 {
        let a = A[stage] * h;
        // The slope of the stage before: its velocity and acceleration.
        w.slope.copy_from_slice(&d.qvel);
        for i in 0..m.nv {
            d.qvel[i] = w.qvel[i] + a * d.qacc[i];
        }
        for i in 0..m.na {
            d.act[i] = w.act[i] + a * d.act_dot[i];
        }
        d.qpos.copy_from_slice(&w.qpos);
        integrate_pos(m, &mut d.qpos, &w.slope, a);
        d.time = start + a;
        pipeline::forward_skip(m, d, Skip::SENSORS);
        for i in 0..m.nv {
            w.dpos[i] += B[stage + 1] * d.qvel[i];
            w.dvel[i] += B[stage + 1] * d.qacc[i];
        }
        for (sum, rate) in w.dact.iter_mut().zip(&d.act_dot) {
            *sum += B[stage + 1] * rate;
        }
    }
    d.qpos.copy_from_slice(&w.qpos);
    d.qvel.copy_from_slice(&w.qvel);
    d.act.copy_from_slice(&w.act);
    d.time = start;
    record(m, d);
    actuation::advance_along(m, d, &w.dact);
    integrate_pos(m, &mut d.qpos, &w.dpos, h);
    for i in 0..m.nv {
        d.qvel[i] = w.qvel[i] + h * w.dvel[i];
    }
    d.time = start + h;
    // The warm start of the next step is the first stage's acceleration.
    d.qacc_warmstart.copy_from_slice(&w.warmstart);
    d.work.rk = w;
}
