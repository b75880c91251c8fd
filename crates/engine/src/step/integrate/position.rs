//! Coordinates and velocities: advancing coordinates with velocities, and the velocities between two configurations.
//!
//! Positions are on a manifold (unit quaternions), so they advance along velocities; coordinates are never added (Hairer, Lubich
//! and Wanner 2006, *Geometric Numerical Integration*, ch. IV).

use crate::kinds::joint;
use crate::math::*;
use crate::model::Model;

/// qpos ← qpos advanced for a time `h` with velocity `v` (`mj_integratePos`).
#[cfg_attr(not(feature = "small"), inline(always))]
pub fn integrate_pos(m: &Model, qpos: &mut [f64], v: &[f64], h: f64) {
    if m.nq == m.nv {
        // Slides and hinges only: coordinates and velocities have the same indexes.
        let n = qpos.len().min(v.len());
        combine(&mut qpos[..n], [v], |q, [v]| q + h * v);
    } else {
        along_joints(m, qpos, v, h);
    }
}

/// Like [`integrate_pos`], for models with quaternions. Coordinates and velocities are processed joint by joint.
#[inline(never)] // scenes with slides and hinges only do not execute its prologue
fn along_joints(m: &Model, mut qpos: &mut [f64], mut v: &[f64], h: f64) {
    for &kind in &m.jnt_type {
        (qpos, v) = match (kind, qpos, v) {
            (joint::SLIDE | joint::HINGE, [q, qpos @ ..], [v, later @ ..]) => {
                *q += h * v;
                (qpos, later)
            }
            (joint::FREE, [x, y, z, qpos @ ..], [vx, vy, vz, v @ ..]) => {
                [*x, *y, *z] = [*x + h * vx, *y + h * vy, *z + h * vz];
                rotate_quaternion(qpos, v, h)
            }
            (_, qpos, v) => rotate_quaternion(qpos, v, h),
        };
    }
}

/// Rotates the quaternion at the start of the coordinates. Returns the coordinates and velocities after it.
#[cfg_attr(not(feature = "small"), inline(always))]
fn rotate_quaternion<'q, 'v>(qpos: &'q mut [f64], v: &'v [f64], h: f64) -> (&'q mut [f64], &'v [f64]) {
    match (qpos.split_first_chunk_mut(), v.split_first_chunk()) {
        (Some((quat, qpos)), Some((&turn, v))) => {
            *quat = quat_integrate(*quat, turn, h);
            (qpos, v)
        }
        _ => Default::default(),
    }
}

/// v ← the velocity that leads from `from` to `to` in a time `h` (`mj_differentiatePos`). Rotations take the shorter direction.
/// Inverse to [`integrate_pos`] for unit quaternions and rotations of less than half a revolution.
pub fn differentiate_pos(m: &Model, v: &mut [f64], h: f64, from: &[f64], to: &[f64]) {
    for j in 0..m.njnt {
        let (mut q, mut k) = (m.jnt_qposadr[j] as usize, m.jnt_dofadr[j] as usize);
        match m.jnt_type[j] {
            joint::SLIDE | joint::HINGE => v[k] = (to[q] - from[q]) / h,
            kind => {
                if kind == joint::FREE {
                    for i in 0..3 {
                        v[k + i] = (to[q + i] - from[q + i]) / h;
                    }
                    (q, k) = (q + 3, k + 3);
                }
                let quat = |list: &[f64]| [list[q], list[q + 1], list[q + 2], list[q + 3]];
                let turn = quat_to_vel(quat_mul(quat_conj(quat(from)), quat(to)));
                for i in 0..3 {
                    v[k + i] = turn[i] / h;
                }
            }
        }
    }
}
