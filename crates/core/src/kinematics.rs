//! Forward kinematics: poses of bodies, joints, geoms and sites from `qpos`.
//!
//! Each body's pose follows from its parent's, joint by joint (Featherstone 2008, section 4.4).

use crate::math::*;
use crate::{Data, Model, joint};

/// How a frame coincides with that of its body, so that poses are copied, not multiplied: the copy is exact.
pub(crate) mod sameframe {
    /// Its own frame.
    pub(crate) const NONE: i32 = 0;
    /// The body's frame.
    pub(crate) const BODY: i32 = 1;
    /// The body's inertial frame.
    pub(crate) const INERTIA: i32 = 2;
    /// The orientation of the body's frame.
    pub(crate) const BODYROT: i32 = 3;
    /// The orientation of the inertial frame.
    pub(crate) const INERTIAROT: i32 = 4;
}

/// The world's pose, which never changes.
pub(crate) fn world(d: &mut Data) {
    if let (Some(q), Some(r), Some(i)) =
        (d.xquat.first_chunk_mut(), d.xmat.first_chunk_mut(), d.ximat.first_chunk_mut())
    {
        (*q, *r, *i) = (IDENTITY, EYE, EYE);
    }
}

/// Poses of bodies and joints: `xpos xquat xmat xipos ximat xanchor xaxis`.
#[inline(never)]
pub(crate) fn bodies(m: &Model, d: &mut Data) {
    let xpos = rows_mut::<3>(&mut d.xpos);
    let xquat = rows_mut::<4>(&mut d.xquat);
    let xmat = rows_mut::<9>(&mut d.xmat);
    let xipos = rows_mut::<3>(&mut d.xipos);
    let ximat = rows_mut::<9>(&mut d.ximat);
    let (xanchor, xaxis) = (rows_mut::<3>(&mut d.xanchor), rows_mut::<3>(&mut d.xaxis));
    let (jnt_pos, jnt_axis) = (rows::<3>(&m.jnt_pos), rows::<3>(&m.jnt_axis));
    let (body_pos, body_quat) = (rows::<3>(&m.body_pos), rows::<4>(&m.body_quat));
    let (body_ipos, body_iquat) = (rows::<3>(&m.body_ipos), rows::<4>(&m.body_iquat));
    let (mocap_pos, mocap_quat) = (rows::<3>(&d.mocap_pos), rows::<4>(&d.mocap_quat));
    let qpos = &d.qpos;

    for i in 1..m.nbody {
        let first = m.body_jntadr[i];
        let joints = m.body_jntnum[i] as usize;
        let (mut pos, mut quat);
        if joints == 1 && m.jnt_type[first as usize] == joint::FREE {
            let j = first as usize;
            let q = &qpos[m.jnt_qposadr[j] as usize..][..7];
            pos = [q[0], q[1], q[2]];
            quat = quat_normalize([q[3], q[4], q[5], q[6]]);
            xanchor[j] = pos;
            xaxis[j] = jnt_axis[j];
        } else {
            let (local_pos, local_quat) = match m.body_mocapid[i] {
                id if id >= 0 => (mocap_pos[id as usize], quat_normalize(mocap_quat[id as usize])),
                _ => (body_pos[i], body_quat[i]),
            };
            let parent = m.body_parentid[i] as usize;
            if parent == 0 {
                (pos, quat) = (local_pos, local_quat);
            } else {
                pos = add(mat_mul_vec(&xmat[parent], local_pos), xpos[parent]);
                quat = quat_mul(xquat[parent], local_quat);
            }
            for j in first as usize..first as usize + joints {
                let q = &qpos[m.jnt_qposadr[j] as usize..];
                // Most joints turn about the origin of their body.
                let central = jnt_pos[j] == [0.0; 3];
                let anchor = if central { pos } else { add(rotate(jnt_pos[j], quat), pos) };
                let axis = rotate(jnt_axis[j], quat);
                xanchor[j] = anchor;
                xaxis[j] = axis;
                let displacement = q[0] - m.qpos0[m.jnt_qposadr[j] as usize];
                let turn = match m.jnt_type[j] {
                    joint::SLIDE => {
                        pos = add_scaled(pos, axis, displacement);
                        continue;
                    }
                    joint::HINGE => quat_axis_angle(jnt_axis[j], displacement),
                    _ => quat_normalize([q[0], q[1], q[2], q[3]]),
                };
                // Rotating about an anchor off the origin moves the origin.
                quat = quat_mul(quat, turn);
                if !central {
                    pos = sub(anchor, rotate(jnt_pos[j], quat));
                }
            }
        }
        quat = quat_normalize(quat);
        xpos[i] = pos;
        xquat[i] = quat;
        xmat[i] = quat_to_mat(quat);
        match m.body_sameframe[i] {
            sameframe::BODY => {
                xipos[i] = pos;
                ximat[i] = xmat[i];
            }
            same => {
                xipos[i] = add(mat_mul_vec(&xmat[i], body_ipos[i]), pos);
                ximat[i] = match same {
                    sameframe::BODYROT => xmat[i],
                    _ => quat_to_mat(quat_mul(quat, body_iquat[i])),
                };
            }
        }
    }
}

/// The poses of bodies that something may be attached to.
struct Poses<'a> {
    xpos: &'a [Vec3],
    xquat: &'a [Quat],
    xmat: &'a [Mat3],
    xipos: &'a [Vec3],
    ximat: &'a [Mat3],
}

impl Poses<'_> {
    /// The pose of something attached to body `b`, by its `sameframe`.
    #[inline(always)]
    fn attached(&self, b: usize, same: i32, pos: Vec3, quat: Quat, out_pos: &mut Vec3, out_mat: &mut Mat3) {
        *out_pos = match same {
            sameframe::BODY => self.xpos[b],
            sameframe::INERTIA => self.xipos[b],
            _ => add(mat_mul_vec(&self.xmat[b], pos), self.xpos[b]),
        };
        *out_mat = match same {
            sameframe::BODY | sameframe::BODYROT => self.xmat[b],
            sameframe::INERTIA | sameframe::INERTIAROT => self.ximat[b],
            _ => quat_to_mat(quat_mul(self.xquat[b], quat)),
        };
    }
}

macro_rules! poses {
    ($d:ident) => {
        Poses {
            xpos: rows(&$d.xpos),
            xquat: rows(&$d.xquat),
            xmat: rows(&$d.xmat),
            xipos: rows(&$d.xipos),
            ximat: rows(&$d.ximat),
        }
    };
}

/// Poses of geoms: `geom_xpos geom_xmat`.
#[inline(never)]
pub(crate) fn geoms(m: &Model, d: &mut Data) {
    let poses = poses!(d);
    let out = rows_mut::<3>(&mut d.geom_xpos).iter_mut().zip(rows_mut::<9>(&mut d.geom_xmat));
    let local = rows::<3>(&m.geom_pos).iter().zip(rows::<4>(&m.geom_quat));
    let on = m.geom_bodyid.iter().zip(&m.geom_sameframe);
    for (((&b, &same), (&pos, &quat)), (p, r)) in on.zip(local).zip(out) {
        poses.attached(b as usize, same, pos, quat, p, r);
    }
}

/// Poses of sites: `site_xpos site_xmat`.
pub(crate) fn sites(m: &Model, d: &mut Data) {
    let poses = poses!(d);
    let out = rows_mut::<3>(&mut d.site_xpos).iter_mut().zip(rows_mut::<9>(&mut d.site_xmat));
    let local = rows::<3>(&m.site_pos).iter().zip(rows::<4>(&m.site_quat));
    let on = m.site_bodyid.iter().zip(&m.site_sameframe);
    for (((&b, &same), (&pos, &quat)), (p, r)) in on.zip(local).zip(out) {
        poses.attached(b as usize, same, pos, quat, p, r);
    }
}
