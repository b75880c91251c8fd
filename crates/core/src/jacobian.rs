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
#[inline(always)]
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

/// The columns of the Jacobian difference of one point fixed to two bodies, J(b2) - J(b1), ascending.
///
/// Fills `cols` with the degrees of freedom that move only one of the bodies (those that move both cancel)
/// and `lin` with the point's velocity for a unit velocity of each.
#[inline]
pub(crate) fn point_difference(m: &Model, d: &Data, b1: usize, b2: usize, point: Vec3, cols: &mut Vec<u32>, lin: &mut Vec<Vec3>) {
    cols.clear();
    lin.clear();
    let (mut i1, mut i2) = (last_dof(m, b1), last_dof(m, b2));
    while i1 != i2 {
        let second = i2 > i1;
        let k = if second { i2 } else { i1 } as usize;
        let v = dof_motion(m, d, k, point).1;
        cols.push(k as u32);
        lin.push(if second { v } else { scale(v, -1.0) });
        let next = m.dof_parentid[k];
        if second {
            i2 = next;
        } else {
            i1 = next;
        }
    }
    cols.reverse();
    lin.reverse();
}
