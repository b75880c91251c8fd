//! The classical Runge–Kutta method of fourth order (Kutta 1901). The velocities of the stages are averaged and applied in
//! one step on the manifold.

use super::{RateOverrides, advance, integrate_pos};
use crate::model::{Fields, Model};
use crate::step::forward;
use crate::step::workspace::StepScratch;

/// Stage s starts from the initial state plus A[s] h times the slope of stage s - 1. B contains the weights of the slopes.
const A: [f64; 3] = [0.5, 0.5, 1.0];
const B: [f64; 4] = [1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0];

pub(super) fn rk4(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    let (h, start) = (m.opt.timestep, d.time);
    let mut w = std::mem::take(&mut s.rk);
    w.qpos.copy_from_slice(&d.qpos);
    w.qvel.copy_from_slice(&d.qvel);
    w.act.copy_from_slice(&d.act);
    assign_scaled(&mut w.dpos, B[0], &d.qvel);
    assign_scaled(&mut w.dvel, B[0], &d.qacc);
    assign_scaled(&mut w.dact, B[0], &d.act_dot);
    for stage in 0..3 {
        let a = A[stage] * h;
        w.slope.copy_from_slice(&d.qvel);
        step(&mut d.qvel, &w.qvel, a, &d.qacc);
        step(&mut d.act, &w.act, a, &d.act_dot);
        d.qpos.copy_from_slice(&w.qpos);
        integrate_pos(m, &mut d.qpos, &w.slope, a);
        d.time = start + a;
        forward::forward_unseen(m, d, s);
        add_scaled(&mut w.dpos, B[stage + 1], &d.qvel);
        add_scaled(&mut w.dvel, B[stage + 1], &d.qacc);
        add_scaled(&mut w.dact, B[stage + 1], &d.act_dot);
    }
    // Advances from the initial state with the weighted sums.
    d.time = start;
    d.qpos.copy_from_slice(&w.qpos);
    d.qvel.copy_from_slice(&w.qvel);
    d.act.copy_from_slice(&w.act);
    advance(
        m,
        d,
        s,
        RateOverrides {
            activation: Some(&mut w.dact),
            acceleration: Some(&w.dvel),
            velocity: Some(&w.dpos),
            ..RateOverrides::default()
        },
    );
    s.rk = w;
}

/// out ← s x
fn assign_scaled(out: &mut [f64], s: f64, x: &[f64]) {
    for (o, x) in out.iter_mut().zip(x) {
        *o = s * x;
    }
}

/// out ← out + s x
fn add_scaled(out: &mut [f64], s: f64, x: &[f64]) {
    for (o, x) in out.iter_mut().zip(x) {
        *o += s * x;
    }
}

/// out ← from + s x
fn step(out: &mut [f64], from: &[f64], s: f64, x: &[f64]) {
    for ((o, from), x) in out.iter_mut().zip(from).zip(x) {
        *o = from + s * x;
    }
}
