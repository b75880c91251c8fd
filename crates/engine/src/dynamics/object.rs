//! Frames of objects and their velocities and accelerations: `mj_objectVelocity`, `mj_objectAcceleration`.
//!
//! The spatial velocity and acceleration of a body are stored about the centre of mass of its tree. Transformed to
//! another point, they are those of an object fixed to the body (Featherstone 2008, section 2.8).

use crate::math::*;
use crate::model::{Fields, Model, Obj};

/// Position and orientation (world frame) and body of an object.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ObjectFrame {
    pub(crate) pos: Vec3,
    pub(crate) mat: Mat3,
    pub(crate) body: usize,
}

/// The frame of an object of type `objtype` (mjtObj). Returns `None` if the object does not exist or has no frame.
pub(crate) fn frame(m: &Model, d: &Fields, objtype: i32, id: usize) -> Option<ObjectFrame> {
    let (pos, mat, body) = match objtype {
        t if t == Obj::Body as i32 => (&d.xipos, &d.ximat, Some(id)),
        t if t == Obj::XBody as i32 => (&d.xpos, &d.xmat, Some(id)),
        t if t == Obj::Geom as i32 => (&d.geom_xpos, &d.geom_xmat, body_of(&m.geom_bodyid, id)),
        t if t == Obj::Site as i32 => (&d.site_xpos, &d.site_xmat, body_of(&m.site_bodyid, id)),
        t if t == Obj::Camera as i32 => (&d.cam_xpos, &d.cam_xmat, body_of(&m.cam_bodyid, id)),
        _ => return None,
    };
    Some(ObjectFrame { pos: *rows(pos).get(id)?, mat: *rows(mat).get(id)?, body: body? })
}

fn body_of(bodies: &[i32], id: usize) -> Option<usize> {
    bodies.get(id).map(|&b| b as usize)
}

/// The orientation of an object in the world as a quaternion, computed from those of the body and of the object in
/// the body. For cameras with a tracking or targeting mode, this is the orientation that the model gives.
pub(crate) fn orientation(m: &Model, d: &Fields, objtype: i32, id: usize) -> Option<Quat> {
    let (frame, body) = match objtype {
        t if t == Obj::XBody as i32 => return rows(&d.xquat).get(id).copied(),
        t if t == Obj::Body as i32 => (&m.body_iquat, Some(id)),
        t if t == Obj::Geom as i32 => (&m.geom_quat, body_of(&m.geom_bodyid, id)),
        t if t == Obj::Site as i32 => (&m.site_quat, body_of(&m.site_bodyid, id)),
        t if t == Obj::Camera as i32 => (&m.cam_quat, body_of(&m.cam_bodyid, id)),
        _ => return None,
    };
    Some(quat_mul(*rows(&d.xquat).get(body?)?, *rows(frame).get(id)?))
}

/// Angular and linear velocity of an object (`mj_objectVelocity`), rad/s and m/s, in world axes, or in the axes of
/// the object if `local`. Zero if the object does not exist.
pub fn object_velocity(m: &Model, d: &Fields, kind: Obj, id: usize, local: bool) -> Spatial {
    let Some(f) = frame(m, d, kind as i32, id) else { return [0.0; 6] };
    velocity(m, d, &f, local)
}

/// Angular and linear acceleration of an object (`mj_objectAcceleration`), rad/s² and m/s², as measured by an
/// accelerometer: for an object at rest it is the acceleration of gravity, directed upwards. The axes are those of
/// [`object_velocity`]. Requires `rne_post_constraint`. Zero for objects that cannot
/// move.
pub fn object_acceleration(m: &Model, d: &Fields, kind: Obj, id: usize, local: bool) -> Spatial {
    let Some(f) = frame(m, d, kind as i32, id) else { return [0.0; 6] };
    acceleration(m, d, &f, local)
}

pub(crate) fn velocity(m: &Model, d: &Fields, f: &ObjectFrame, local: bool) -> Spatial {
    let v = shifted_motion(m, d, f, &rows::<6>(&d.cvel)[f.body]);
    if local { rotated_spatial(&f.mat, &v) } else { v }
}

pub(crate) fn acceleration(m: &Model, d: &Fields, f: &ObjectFrame, local: bool) -> Spatial {
    if m.body_treeid[f.body] < 0 {
        return [0.0; 6];
    }
    let mut a = shifted_motion(m, d, f, &rows::<6>(&d.cacc)[f.body]);
    let v = shifted_motion(m, d, f, &rows::<6>(&d.cvel)[f.body]);
    // The linear part is the acceleration of the body-fixed point; the acceleration along its path in space has the
    // additional term ω × v.
    let bend = cross(angular(&v), linear(&v));
    for i in 0..3 {
        a[3 + i] += bend[i];
    }
    if local { rotated_spatial(&f.mat, &a) } else { a }
}

/// Transforms a motion of the body of `f`, given about the centre of mass of its tree, to the position of `f`.
fn shifted_motion(m: &Model, d: &Fields, f: &ObjectFrame, motion: &Spatial) -> Spatial {
    let com = rows::<3>(&d.subtree_com)[m.body_rootid[f.body] as usize];
    let w = angular(motion);
    let l = add(linear(motion), cross(w, sub(f.pos, com)));
    [w[0], w[1], w[2], l[0], l[1], l[2]]
}

/// Rotates both parts to the axes of `mat`.
pub(crate) fn rotated_spatial(mat: &Mat3, s: &Spatial) -> Spatial {
    let (w, l) = (mat_t_mul_vec(mat, angular(s)), mat_t_mul_vec(mat, linear(s)));
    [w[0], w[1], w[2], l[0], l[1], l[2]]
}
