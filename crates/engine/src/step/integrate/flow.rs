//! A step as an initial value problem in a vector space.
//!
//! Rotations in space cannot be added. Therefore a configuration is expressed as the one at the start of the step, moved by u:
//! q = q₀ exp(u), where u consists of a displacement of each slide and hinge, and a rotation vector of each ball joint, in its
//! own frame. Then u̇ = dexp⁻¹(u) v, v̇ = a(q, v, t). A method of order p for such equations has order p for rotating bodies too
//! (Munthe-Kaas 1999, *High order Runge-Kutta methods on manifolds*; Iserles, Munthe-Kaas, Nørsett and Zanna 2000, *Lie-group
//! methods*).
//!
//! The state is one list: u and v, each of length nv, and the activations.

use super::{RateOverrides, advance, integrate_pos};
use crate::forces::actuation;
use crate::kinds::joint;
use crate::math::*;
use crate::model::{Fields, Model};
use crate::step::forward;
use crate::step::stages::Flow;
use crate::step::workspace::StepScratch;

/// Starts a step of a method with this number of stages. The forces of the current state must be known. `finish` ends the step.
pub(super) fn enter(m: &Model, d: &mut Fields, s: &mut StepScratch, stages: usize) -> Flow {
    let mut w = std::mem::take(&mut s.flow);
    w.make_room(m, stages);
    (w.began, w.energy) = (d.time, d.energy);
    begin(m, d, &mut w);
    w
}

/// Starts the coordinates at the current state of the data, whose forces must be known.
fn begin(m: &Model, d: &Fields, w: &mut Flow) {
    w.qpos.copy_from_slice(&d.qpos);
    w.time = d.time;
    let (u, rest) = w.start.split_at_mut(m.nv);
    let (v, act) = rest.split_at_mut(m.nv);
    u.fill(0.0);
    v.copy_from_slice(&d.qvel);
    act.copy_from_slice(&d.act);
    known_slope(m, d, &w.start, &mut w.first);
}

/// Sets the state of the data from a list, at a time after the start.
fn place(m: &Model, d: &mut Fields, w: &Flow, after: f64, state: &[f64]) {
    let (u, rest) = state.split_at(m.nv);
    let (v, act) = rest.split_at(m.nv);
    d.qpos.copy_from_slice(&w.qpos);
    integrate_pos(m, &mut d.qpos, u, 1.0);
    d.qvel.copy_from_slice(v);
    d.act.copy_from_slice(act);
    d.time = w.time + after;
}

/// The slope at the current state of the data, whose forces must be known.
fn known_slope(m: &Model, d: &Fields, state: &[f64], out: &mut [f64]) {
    let (du, rest) = out.split_at_mut(m.nv);
    let (dv, da) = rest.split_at_mut(m.nv);
    du.copy_from_slice(&d.qvel);
    for (&kind, &k) in m.jnt_type.iter().zip(&m.jnt_dofadr) {
        let k = k as usize + if kind == joint::FREE { 3 } else { 0 };
        if matches!(kind, joint::FREE | joint::BALL)
            && let Some(u) = state.get(k..).and_then(|u| u.first_chunk())
            && let Some(du) = du.get_mut(k..).and_then(|du| du.first_chunk_mut())
        {
            *du = rotation_vector_rate(*u, *du);
        }
    }
    dv.copy_from_slice(&d.qacc);
    da.copy_from_slice(&d.act_dot);
}

/// Computes the forces for a state, and its slope.
pub(super) fn slope(
    m: &Model,
    d: &mut Fields,
    s: &mut StepScratch,
    w: &Flow,
    after: f64,
    state: &[f64],
    out: &mut [f64],
) {
    place(m, d, w, after, state);
    forward::forward_unseen(m, d, s);
    known_slope(m, d, state, out);
}

/// The time derivative of the rotation vector u of a body whose angular velocity is w, both in the body's own frame:
/// dexp⁻¹(u) w = w + u×w/2 + (1 - (θ/2) cot(θ/2))/θ² u×(u×w) with θ = |u|.
fn rotation_vector_rate(u: Vec3, w: Vec3) -> Vec3 {
    let square = dot(u, u);
    if square == 0.0 {
        return w;
    }
    let factor = if square < 1e-4 {
        // The next term of the series is 1e-14 of the first.
        1.0 / 12.0 + square * (1.0 / 720.0 + square / 30240.0)
    } else {
        let half = 0.5 * square.sqrt();
        (1.0 - half * libm::cos(half) / libm::sin(half)) / square
    };
    let (once, twice) = (cross(u, w), cross(u, cross(u, w)));
    std::array::from_fn(|i| w[i] + 0.5 * once[i] + factor * twice[i])
}

/// Continues from the end of a part of the step, which becomes the start of the next part. Computes its forces.
pub(super) fn begin_next_part(m: &Model, d: &mut Fields, s: &mut StepScratch, w: &mut Flow, part: f64) {
    let end = std::mem::take(&mut w.end);
    place(m, d, w, part, &end);
    actuation::arrive(m, d, &end[2 * m.nv..]);
    w.end = end;
    forward::forward_unseen(m, d, s);
    begin(m, d, w);
}

/// Ends the step. `w.end` must contain the state at its end.
pub(super) fn finish(m: &Model, d: &mut Fields, s: &mut StepScratch, mut w: Flow) {
    let h = m.opt.timestep;
    let (u, rest) = w.end.split_at_mut(m.nv);
    let (v, act) = rest.split_at_mut(m.nv);
    d.qpos.copy_from_slice(&w.qpos);
    d.qvel.copy_from_slice(&w.start[m.nv..2 * m.nv]);
    d.act.copy_from_slice(&w.start[2 * m.nv..]);
    d.time = w.began;
    d.energy = w.energy;
    for (v, start) in v.iter_mut().zip(&d.qvel) {
        *v = (*v - start) / h;
    }
    u.iter_mut().for_each(|u| *u /= h);
    advance(
        m,
        d,
        s,
        RateOverrides {
            reached: Some(act),
            acceleration: Some(v),
            velocity: Some(u),
            ..RateOverrides::default()
        },
    );
    s.flow = w;
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Compares the formula with the finite difference of the rotation vector of q₀⁻¹ q, for q = exp(u) followed by a short
    /// rotation with w.
    #[test]
    fn the_rate_of_a_rotation_vector() {
        for size in [0.0, 1e-9, 1e-3, 0.00999, 0.0101, 0.5, 2.0, 3.0] {
            let u = [0.36 * size, -0.48 * size, 0.8 * size];
            let (w, h) = ([0.3, 1.1, -0.7], 1e-5);
            let turned =
                |h: f64| quat_to_vel(quat_integrate(quat_integrate([1.0, 0.0, 0.0, 0.0], u, 1.0), w, h));
            let (before, after) = (turned(-h), turned(h));
            let rate = rotation_vector_rate(u, w);
            for i in 0..3 {
                let measured = (after[i] - before[i]) / (2.0 * h);
                assert!((rate[i] - measured).abs() < 1e-8, "{size}: {} for {measured}", rate[i]);
            }
        }
    }
}
