//! Jacobians of points: how the velocity of a point follows from `qvel`.

use crate::math::*;
use crate::{Data, Model, joint};

/// Last degree of freedom that moves body `b`, -1 when it cannot move.
#[inline(always)]
pub(crate) fn last_dof(m: &Model, b: usize) -> i32 {
    let w = m.body_weldid[b] as usize;
    m.body_dofadr[w] + m.body_dofnum[w] - i32::from(m.body_dofnum[w] > 0)
}

/// Angular velocity, and the velocity of `point`, for a unit velocity of degree of freedom `k`.
pub(crate) fn dof_motion(m: &Model, d: &Data, k: usize, point: Vec3) -> (Vec3, Vec3) {
    let j = m.dof_jntid[k] as usize;
    let i = k - m.jnt_dofadr[j] as usize;
    let axis = match m.jnt_type[j] {
        joint::SLIDE => return ([0.0; 3], rows::<3>(&d.xaxis)[j]),
        joint::HINGE => rows::<3>(&d.xaxis)[j],
        joint::FREE if i < 3 => return ([0.0; 3], std::array::from_fn(|c| f64::from(u8::from(c == i)))),
        // Ball and free rotations: the body's own axes.
        _ => column(&rows::<9>(&d.xmat)[m.jnt_bodyid[j] as usize], i % 3),
    };
    (axis, cross(axis, sub(point, rows::<3>(&d.xanchor)[j])))
}

/// The Jacobian difference of one point fixed to two bodies, J(b2) - J(b1), along the rows of `frame`.
///
/// Fills `cols` with the degrees of freedom that move only one of the bodies (those that move both cancel),
/// descending, and `out` with the velocity of the point along each row for a unit velocity of each.
#[inline(always)]
pub(crate) fn point_difference(
    m: &Model,
    d: &Data,
    bodies: [usize; 2],
    point: Vec3,
    frame: &Mat3,
    cols: &mut Vec<u32>,
    out: &mut Vec<Vec3>,
) {
    cols.clear();
    out.clear();
    let mut last = bodies.map(|b| last_dof(m, b));
    while last[0] != last[1] {
        // The chain that reaches farther down goes one joint up.
        let side = usize::from(last[1] > last[0]);
        let sign = if side == 1 { 1.0 } else { -1.0 };
        let end = last[side] as usize;
        let j = m.dof_jntid[end] as usize;
        joint_columns(m, d, j, point, frame, sign, out);
        let first = m.jnt_dofadr[j] as usize;
        cols.extend((first..=end).rev().map(|k| k as u32));
        last[side] = m.dof_parentid[first];
    }
}

/// Columns of one joint, the last degree of freedom first. A rotation about `a` moves the point by a × arm,
/// and (a × arm) · f = a · (arm × f).
#[inline(always)]
fn joint_columns(m: &Model, d: &Data, j: usize, point: Vec3, frame: &Mat3, sign: f64, out: &mut Vec<Vec3>) {
    let f: [Vec3; 3] = std::array::from_fn(|r| scale([frame[3 * r], frame[3 * r + 1], frame[3 * r + 2]], sign));
    let along = |a: Vec3| [dot(a, f[0]), dot(a, f[1]), dot(a, f[2])];
    let kind = m.jnt_type[j];
    if kind == joint::SLIDE {
        out.push(along(rows::<3>(&d.xaxis)[j]));
        return;
    }
    let arm = sub(point, rows::<3>(&d.xanchor)[j]);
    let w = [cross(arm, f[0]), cross(arm, f[1]), cross(arm, f[2])];
    if kind == joint::HINGE {
        let a = rows::<3>(&d.xaxis)[j];
        out.push([dot(a, w[0]), dot(a, w[1]), dot(a, w[2])]);
        return;
    }
    let axes = &rows::<9>(&d.xmat)[m.jnt_bodyid[j] as usize];
    let turn = w.map(|w| mat_t_mul_vec(axes, w));
    for i in (0..3).rev() {
        out.push([turn[0][i], turn[1][i], turn[2][i]]);
    }
    if kind == joint::FREE {
        for i in (0..3).rev() {
            out.push([f[0][i], f[1][i], f[2][i]]);
        }
    }
}
