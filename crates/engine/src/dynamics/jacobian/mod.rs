//! Jacobians of points: the linear map from `qvel` to the velocity of a point.

mod points;

use super::walk::{self, Side, last_dof};
use crate::kinds::joint;
use crate::math::lanes::{Axes, Lane3, along, axes, vec3};
use crate::math::*;
use crate::model::{Fields, Model};

pub use points::Jacobian;
pub use points::{apply_ft, jac, jac_body, jac_body_com, jac_dot, jac_geom, jac_site, jac_subtree_com};

/// Angular velocity of the body and velocity of `point` for a unit velocity of degree of freedom `k`.
pub(crate) fn dof_motion(m: &Model, d: &Fields, k: usize, point: Vec3) -> (Vec3, Vec3) {
    let j = m.dof_jntid[k] as usize;
    let i = k - m.jnt_dofadr[j] as usize;
    let axis = match m.jnt_type[j] {
        joint::SLIDE => return ([0.0; 3], rows::<3>(&d.xaxis)[j]),
        joint::HINGE => rows::<3>(&d.xaxis)[j],
        joint::FREE if i < 3 => return ([0.0; 3], std::array::from_fn(|c| f64::from(u8::from(c == i)))),
        // The rotation axes of ball and free joints are the axes of the body.
        _ => column(&rows::<9>(&d.xmat)[m.jnt_bodyid[j] as usize], i % 3),
    };
    (axis, cross(axis, sub(point, rows::<3>(&d.xanchor)[j])))
}

/// out += Jᵀ f: the generalized force of a force at `point` and a torque on body `b`. A rotation about an axis through the
/// anchor of its joint has the component along the axis of torque + arm × force.
pub(crate) fn apply(
    m: &Model,
    d: &Fields,
    b: usize,
    point: Vec3,
    force: Vec3,
    torque: Vec3,
    out: &mut [f64],
) {
    let mut last = last_dof(m, b);
    while let Ok(dof) = usize::try_from(last) {
        let j = m.dof_jntid[dof] as usize;
        let first = m.jnt_dofadr[j] as usize;
        let axis = rows::<3>(&d.xaxis)[j];
        let moment = || add(torque, cross(sub(point, rows::<3>(&d.xanchor)[j]), force));
        let add_at =
            |out: &mut [f64], dof: usize, v: Vec3| out[dof..].iter_mut().zip(v).for_each(|(to, v)| *to += v);
        match m.jnt_type[j] {
            joint::SLIDE => out[dof] += dot(axis, force),
            joint::HINGE => out[dof] += dot(axis, moment()),
            kind => {
                if kind == joint::FREE {
                    add_at(out, first, force);
                }
                // The axes of rotation of ball and free joints are those of the body.
                add_at(out, dof - 2, mat_t_mul_vec(&rows::<9>(&d.xmat)[m.jnt_bodyid[j] as usize], moment()));
            }
        }
        last = m.dof_parentid[first];
    }
}

/// Columns of a Jacobian in the axes of a frame, in descending order of the degrees of freedom. The arrays have a
/// capacity for all degrees of freedom of the model.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Columns {
    dofs: Vec<u32>,
    values: Vec<Vec3>,
    turns: Vec<Vec3>,
    len: usize,
}

impl Columns {
    pub(crate) fn with_room(nv: usize) -> Columns {
        Columns { dofs: vec![0; nv], values: vec![[0.0; 3]; nv], turns: vec![[0.0; 3]; nv], len: 0 }
    }

    /// The degrees of freedom of the island.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(crate) fn dofs(&self) -> &[u32] {
        &self.dofs[..self.len]
    }

    /// Velocity of the point along each row of the frame, for a unit velocity of each degree of freedom.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(crate) fn values(&self) -> &[Vec3] {
        &self.values[..self.len]
    }

    /// Angular velocity along each row of the frame, for a unit velocity of each degree of freedom. Valid only after
    /// a function computed it.
    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(crate) fn angular_part(&self) -> &[Vec3] {
        &self.turns[..self.len]
    }

    #[cfg_attr(not(feature = "small"), inline(always))]
    pub(crate) fn angular_part_mut(&mut self) -> &mut [Vec3] {
        &mut self.turns[..self.len]
    }

    /// Writes a single column of zeros for a moving body, so that a row is assigned to its tree. Returns whether the
    /// body can move.
    pub(crate) fn push_zero_column(&mut self, m: &Model, body: usize) -> bool {
        let Ok(last) = usize::try_from(last_dof(m, body)) else { return false };
        (self.dofs[0], self.values[0], self.turns[0]) = (last as u32, [0.0; 3], [0.0; 3]);
        self.len = 1;
        true
    }

    /// Appends N columns for the degrees of freedom `last`, `last` - 1, ….
    #[cfg_attr(not(feature = "small"), inline(always))]
    fn push<const N: usize>(&mut self, last: usize, values: [Lane3; N]) {
        let range = self.len..self.len + N;
        self.len += N;
        for (i, k) in self.dofs[range.clone()].iter_mut().enumerate() {
            *k = (last - i) as u32;
        }
        for (to, value) in self.values[range].iter_mut().zip(values) {
            *to = vec3(value);
        }
    }
}

/// The Jacobian difference of a point fixed to two bodies, J(b2) - J(b1), in the axes given by the rows of `frame`.
/// Only degrees of freedom that move one of the bodies have columns; those that move both cancel.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn point_difference(
    m: &Model,
    d: &Fields,
    bodies: [usize; 2],
    point: Vec3,
    frame: &Mat3,
    out: &mut Columns,
) {
    out.len = 0;
    let mut last = [last_dof(m, bodies[0]), last_dof(m, bodies[1])];
    // The frame by columns: each lane corresponds to a row.
    let frame = axes(frame);
    while last[0] != last[1] {
        // The chain with the larger degree of freedom moves up by one joint.
        let side = usize::from(last[1] > last[0]);
        let sign = if side == 1 { 1.0 } else { -1.0 };
        let end = last[side] as usize;
        let j = m.dof_jntid[end] as usize;
        joint_columns(m, d, j, end, point, frame.map(|f| f * sign), out);
        last[side] = m.dof_parentid[m.jnt_dofadr[j] as usize];
    }
}

/// Appends the columns of one joint, the last degree of freedom first. A rotation about `a` moves the point by v = a
/// × arm, so v · f = a · (arm × f).
#[cfg_attr(not(feature = "small"), inline(always))]
fn joint_columns(m: &Model, d: &Fields, j: usize, last: usize, point: Vec3, f: Axes, out: &mut Columns) {
    let kind = m.jnt_type[j];
    if kind == joint::SLIDE {
        out.push(last, [along(&f, rows::<3>(&d.xaxis)[j])]);
        return;
    }
    let arm = sub(point, rows::<3>(&d.xanchor)[j]);
    if kind == joint::HINGE {
        out.push(last, [along(&f, cross(rows::<3>(&d.xaxis)[j], arm))]);
        return;
    }
    // All three axes of the body.
    let w = [f[2] * arm[1] - f[1] * arm[2], f[0] * arm[2] - f[2] * arm[0], f[1] * arm[0] - f[0] * arm[1]];
    let axes = &rows::<9>(&d.xmat)[m.jnt_bodyid[j] as usize];
    let turn = |i: usize| along(&w, column(axes, i));
    if kind == joint::FREE {
        out.push(last, [turn(2), turn(1), turn(0), f[2], f[1], f[0]]);
    } else {
        out.push(last, [turn(2), turn(1), turn(0)]);
    }
}

/// The rotational part for [`point_difference`]: the difference of the angular velocities along the rows of `frame`,
/// for the columns in `out`.
pub(crate) fn rotation_difference(
    m: &Model,
    d: &Fields,
    bodies: [usize; 2],
    frame: &Mat3,
    out: &mut Columns,
) {
    for (turn, (k, side)) in out.angular_part_mut().iter_mut().zip(walk::moving_one(m, bodies)) {
        let (w, _) = dof_motion(m, d, k, [0.0; 3]);
        *turn = mat_mul_vec(frame, scale(w, if side == 1 { 1.0 } else { -1.0 }));
    }
}

/// The Jacobian difference of two points, each fixed to a body, J(b1) - J(b2), and that of the angular velocities, in
/// world axes. Degrees of freedom that move both bodies are included, because they move the two points differently.
pub(crate) fn pair_difference(
    m: &Model,
    d: &Fields,
    bodies: [usize; 2],
    points: [Vec3; 2],
    out: &mut Columns,
) {
    out.len = 0;
    for (dof, moved) in walk::moving_either(m, bodies) {
        let (mut shift, mut turn) = ([0.0; 3], [0.0; 3]);
        for (point, sign, other) in [(points[0], 1.0, Side::Second), (points[1], -1.0, Side::First)] {
            if moved != other {
                let (w, v) = dof_motion(m, d, dof, point);
                (shift, turn) = (add_scaled(shift, v, sign), add_scaled(turn, w, sign));
            }
        }
        let index = out.len;
        (out.dofs[index], out.values[index], out.turns[index]) = (dof as u32, shift, turn);
        out.len += 1;
    }
}

/// Motion of a point of a body with zero joint accelerations.
pub(crate) struct Unforced {
    /// Velocity and acceleration of the point.
    pub(crate) velocity: Vec3,
    pub(crate) acceleration: Vec3,
    /// Angular velocity and angular acceleration of the body.
    pub(crate) spin: Vec3,
    pub(crate) turn: Vec3,
}

/// J v and J̇ v of a point of body `b`, for translation and rotation. Requires `cvel` and `cdof_dot`.
pub(crate) fn unforced(m: &Model, d: &Fields, b: usize, point: Vec3) -> Unforced {
    let mut rate = [0.0; 6];
    for dof in walk::moving(m, b) {
        rate = add_scaled(rate, rows::<6>(&d.cdof_dot)[dof], d.qvel[dof]);
    }
    let motion = &rows::<6>(&d.cvel)[b];
    let arm = sub(point, rows::<3>(&d.subtree_com)[m.body_rootid[b] as usize]);
    let (spin, turn) = (angular(motion), angular(&rate));
    let velocity = add(linear(motion), cross(spin, arm));
    // The last term is the acceleration of a point that is fixed to the rotating body.
    let acceleration = add(add(linear(&rate), cross(turn, arm)), cross(spin, velocity));
    Unforced { velocity, acceleration, spin, turn }
}
