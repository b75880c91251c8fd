//! Forward kinematics: poses of bodies, joints, geoms and sites from `qpos`.
//!
//! The pose of each body is computed from that of its parent, joint by joint (Featherstone 2008, section 4.4).

use crate::kinds::joint;
use crate::math::lanes::{Axes, Lane3, along, axes, lane3, matrix, product, turned, vec3};
use crate::math::*;
use crate::model::index::element_range;
use crate::model::reflect::{FieldId, model as fields_of};
use crate::model::{Fields, Model};
use std::ops::Range;

/// Values of `sameframe`: which frame of its body a frame coincides with. Poses of coinciding frames are copied
/// instead of multiplied, which is exact.
pub mod sameframe {
    /// It coincides with no frame of the body.
    pub const NONE: i32 = 0;
    /// Position and orientation coincide with the body frame.
    pub const BODY: i32 = 1;
    /// Position and orientation coincide with the inertial frame of the body.
    pub const INERTIA: i32 = 2;
    /// Only the orientation coincides with that of the body frame.
    pub const BODYROT: i32 = 3;
    /// Only the orientation coincides with that of the inertial frame.
    pub const INERTIAROT: i32 = 4;
}

/// The pose of the world body, which is constant.
pub(crate) fn world(d: &mut Fields) {
    if let (Some(q), Some(r), Some(i)) =
        (d.xquat.first_chunk_mut(), d.xmat.first_chunk_mut(), d.ximat.first_chunk_mut())
    {
        (*q, *r, *i) = (IDENTITY, EYE, EYE);
    }
}

/// Parameters of bodies and joints, copied from the model in the order of use.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Frames {
    bodies: Vec<BodyParameters>,
    joints: Vec<JointParameters>,
    /// Poses of bodies, read by their children.
    poses: Vec<BodyPose>,
}

/// The origin and the axes of a body, world frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct BodyPose {
    pos: Lane3,
    axes: Axes,
}

/// Parameters of a body.
#[derive(Clone, Debug, Default, PartialEq)]
struct BodyParameters {
    parent: usize,
    joints: Range<usize>,
    free: bool,
    mocap: Option<usize>,
    /// Pose in the frame of its parent, before its joints move it. `straight` is set if the orientation is the
    /// identity.
    pos: Vec3,
    quat: Quat,
    axes: [Vec3; 3],
    straight: bool,
    /// Centre of mass and principal axes of inertia in the frame of the body.
    com: Vec3,
    principal: [Vec3; 3],
    same: i32,
}

/// Parameters of a joint, and the angle of a hinge.
#[derive(Clone, Debug, Default, PartialEq)]
struct JointParameters {
    kind: i32,
    /// Index of its first coordinate in `qpos`.
    coordinate: usize,
    /// The coordinate for which the body has the pose given in the model (`qpos0`).
    reference: f64,
    anchor: Vec3,
    /// Whether its anchor is the origin of the body, as for most joints.
    central: bool,
    axis: Vec3,
    /// Sine and cosine of half the angle of a hinge.
    half: (f64, f64),
}

/// Fields of the model that determine these parameters.
pub(crate) const FIELDS: [FieldId; 7] = [
    fields_of::body_pos,
    fields_of::body_quat,
    fields_of::body_ipos,
    fields_of::body_iquat,
    fields_of::jnt_pos,
    fields_of::jnt_axis,
    fields_of::qpos0,
];

impl Frames {
    /// Creates the parameters of a model.
    pub(crate) fn new(m: &Model) -> Frames {
        let body = |i: usize| {
            let joints = element_range(m.body_jntadr[i], m.body_jntnum[i]);
            BodyParameters {
                parent: m.body_parentid[i] as usize,
                free: joints.len() == 1 && m.jnt_type[joints.start] == joint::FREE,
                joints,
                mocap: usize::try_from(m.body_mocapid[i]).ok(),
                ..BodyParameters::default()
            }
        };
        let joint = |j: usize| JointParameters {
            kind: m.jnt_type[j],
            coordinate: m.jnt_qposadr[j] as usize,
            ..JointParameters::default()
        };
        let world = BodyPose { pos: lane3([0.0; 3]), axes: axes(&EYE) };
        let mut frames = Frames {
            bodies: (0..m.nbody).map(body).collect(),
            joints: (0..m.njnt).map(joint).collect(),
            poses: vec![world; m.nbody],
        };
        frames.load(m);
        frames
    }

    /// Reads from the model the parameters that can be written.
    pub(crate) fn load(&mut self, m: &Model) {
        let places = rows::<3>(&m.body_pos).iter().zip(rows::<4>(&m.body_quat));
        let inertial = rows::<3>(&m.body_ipos).iter().zip(rows::<4>(&m.body_iquat)).zip(&m.body_sameframe);
        for (f, ((&pos, &quat), ((&com, &principal), &same))) in
            self.bodies.iter_mut().zip(places.zip(inertial))
        {
            let quat = quat_normalize(quat);
            (f.pos, f.quat, f.axes, f.straight) = (pos, quat, columns(quat), quat == IDENTITY);
            (f.com, f.principal, f.same) = (com, columns(principal), same);
        }
        let anchors = rows::<3>(&m.jnt_pos).iter().zip(rows::<3>(&m.jnt_axis));
        for (j, (&anchor, &axis)) in self.joints.iter_mut().zip(anchors) {
            (j.anchor, j.central, j.axis) = (anchor, anchor == [0.0; 3], axis);
            j.reference = m.qpos0[j.coordinate];
        }
    }
}

/// Poses of bodies and joints: `xpos xmat xipos ximat xanchor xaxis`.
#[inline(never)]
pub(crate) fn bodies(d: &mut Fields, frames: &mut Frames) {
    let Frames { bodies, joints, poses } = frames;
    let (xpos, xmat) = (rows_mut::<3>(&mut d.xpos), rows_mut::<9>(&mut d.xmat));
    let (xipos, ximat) = (rows_mut::<3>(&mut d.xipos), rows_mut::<9>(&mut d.ximat));
    let (xanchor, xaxis) = (rows_mut::<3>(&mut d.xanchor), rows_mut::<3>(&mut d.xaxis));
    let (mocap_pos, mocap_quat) = (rows::<3>(&d.mocap_pos), rows::<4>(&d.mocap_quat));
    let qpos = &d.qpos;

    // Before the poses, so that these computations do not wait for each other.
    for joint in joints.iter_mut().filter(|joint| joint.kind == joint::HINGE) {
        joint.half = libm::sincos(0.5 * (qpos[joint.coordinate] - joint.reference));
    }
    for (i, f) in bodies.iter().enumerate().skip(1) {
        let mut here;
        if f.free {
            let (j, q) = (f.joints.start, joints[f.joints.start].coordinate);
            let pos = [qpos[q], qpos[q + 1], qpos[q + 2]];
            here = BodyPose { pos: lane3(pos), axes: axes(&quat_to_mat(quaternion(&qpos[q + 3..]))) };
            (xanchor[j], xaxis[j]) = (pos, joints[j].axis);
        } else {
            let above = &poses[f.parent];
            here = match f.mocap {
                Some(id) => BodyPose {
                    pos: above.pos + along(&above.axes, mocap_pos[id]),
                    axes: product(&above.axes, &columns(quat_normalize(mocap_quat[id]))),
                },
                None => BodyPose {
                    pos: above.pos + along(&above.axes, f.pos),
                    axes: if f.straight { above.axes } else { product(&above.axes, &f.axes) },
                },
            };
            let out = xanchor[f.joints.clone()].iter_mut().zip(&mut xaxis[f.joints.clone()]);
            for (joint, (xanchor, xaxis)) in joints[f.joints.clone()].iter().zip(out) {
                let axis = along(&here.axes, joint.axis);
                let anchor =
                    if joint.central { here.pos } else { here.pos + along(&here.axes, joint.anchor) };
                (*xanchor, *xaxis) = (vec3(anchor), vec3(axis));
                match joint.kind {
                    joint::SLIDE => {
                        here.pos += axis * (qpos[joint.coordinate] - joint.reference);
                        continue;
                    }
                    joint::HINGE => {
                        let (s, c) = joint.half;
                        here.axes = turned(&here.axes, joint.axis, 2.0 * s * c, 1.0 - 2.0 * s * s);
                    }
                    _ => here.axes = product(&here.axes, &columns(quaternion(&qpos[joint.coordinate..]))),
                }
                // A rotation about an anchor off the origin moves the origin.
                if !joint.central {
                    here.pos = anchor - along(&here.axes, joint.anchor);
                }
            }
        }
        poses[i] = here;
        (xpos[i], xmat[i]) = (vec3(here.pos), matrix(&here.axes));
        // Coinciding frames are copied, which is exact.
        let same_axes = matches!(f.same, sameframe::BODY | sameframe::BODYROT);
        xipos[i] =
            if f.same == sameframe::BODY { xpos[i] } else { vec3(here.pos + along(&here.axes, f.com)) };
        ximat[i] = if same_axes { xmat[i] } else { matrix(&product(&here.axes, &f.principal)) };
    }
}

/// The columns of the rotation matrix of a quaternion.
#[cfg_attr(not(feature = "small"), inline(always))]
fn columns(quat: Quat) -> [Vec3; 3] {
    let m = quat_to_mat(quat);
    [column(&m, 0), column(&m, 1), column(&m, 2)]
}

/// Four coordinates as a unit quaternion.
#[cfg_attr(not(feature = "small"), inline(always))]
fn quaternion(q: &[f64]) -> Quat {
    quat_normalize([q[0], q[1], q[2], q[3]])
}

/// Orientations of bodies as quaternions, `xquat`, after [`bodies`].
#[inline(never)]
pub(crate) fn orientations(d: &mut Fields, frames: &Frames) {
    let Frames { bodies, joints, .. } = frames;
    let xquat = rows_mut::<4>(&mut d.xquat);
    let (mocap_quat, qpos) = (rows::<4>(&d.mocap_quat), &d.qpos);
    for (i, f) in bodies.iter().enumerate().skip(1) {
        let mut quat = match f.mocap {
            _ if f.free => IDENTITY,
            Some(id) => quat_normalize(mocap_quat[id]),
            None => f.quat,
        };
        if f.parent > 0 && !f.free {
            let above = xquat[f.parent];
            quat = if f.straight && f.mocap.is_none() { above } else { quat_mul(above, quat) };
        }
        for joint in &joints[f.joints.clone()] {
            quat = match joint.kind {
                joint::SLIDE => continue,
                joint::HINGE => {
                    let (s, c) = joint.half;
                    quat_mul(quat, [c, joint.axis[0] * s, joint.axis[1] * s, joint.axis[2] * s])
                }
                joint::FREE => quaternion(&qpos[joint.coordinate + 3..]),
                _ => quat_mul(quat, quaternion(&qpos[joint.coordinate..])),
            };
        }
        xquat[i] = quat_normalize(quat);
    }
}

/// The poses of bodies and inertial frames, for attached frames.
struct Poses<'a> {
    xpos: &'a [Vec3],
    xmat: &'a [Mat3],
    xipos: &'a [Vec3],
    ximat: &'a [Mat3],
}

impl Poses<'_> {
    /// Computes the pose of a frame attached to body `b`, using its `sameframe`.
    #[cfg_attr(not(feature = "small"), inline(always))]
    fn attached(&self, b: usize, same: i32, pos: Vec3, quat: Quat, out_pos: &mut Vec3, out_mat: &mut Mat3) {
        *out_pos = match same {
            sameframe::BODY => self.xpos[b],
            sameframe::INERTIA => self.xipos[b],
            _ => add(mat_mul_vec(&self.xmat[b], pos), self.xpos[b]),
        };
        *out_mat = match same {
            sameframe::BODY | sameframe::BODYROT => self.xmat[b],
            sameframe::INERTIA | sameframe::INERTIAROT => self.ximat[b],
            _ => mat_mul(&self.xmat[b], &quat_to_mat(quat)),
        };
    }
}

macro_rules! poses {
    ($d:ident) => {
        Poses { xpos: rows(&$d.xpos), xmat: rows(&$d.xmat), xipos: rows(&$d.xipos), ximat: rows(&$d.ximat) }
    };
}

/// Poses of geoms: `geom_xpos geom_xmat`.
#[inline(never)]
pub(crate) fn geoms(m: &Model, d: &mut Fields) {
    let poses = poses!(d);
    let out = rows_mut::<3>(&mut d.geom_xpos).iter_mut().zip(rows_mut::<9>(&mut d.geom_xmat));
    let local = rows::<3>(&m.geom_pos).iter().zip(rows::<4>(&m.geom_quat));
    let on = m.geom_bodyid.iter().zip(&m.geom_sameframe);
    for (((&b, &same), (&pos, &quat)), (p, r)) in on.zip(local).zip(out) {
        poses.attached(b as usize, same, pos, quat, p, r);
    }
}

/// Poses of sites: `site_xpos site_xmat`.
pub(crate) fn sites(m: &Model, d: &mut Fields) {
    let poses = poses!(d);
    let out = rows_mut::<3>(&mut d.site_xpos).iter_mut().zip(rows_mut::<9>(&mut d.site_xmat));
    let local = rows::<3>(&m.site_pos).iter().zip(rows::<4>(&m.site_quat));
    let on = m.site_bodyid.iter().zip(&m.site_sameframe);
    for (((&b, &same), (&pos, &quat)), (p, r)) in on.zip(local).zip(out) {
        poses.attached(b as usize, same, pos, quat, p, r);
    }
}
