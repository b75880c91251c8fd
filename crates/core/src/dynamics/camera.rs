//! Poses of cameras and lights, which may follow a body or look at one.

use crate::math::*;
use crate::model::asleep::{self, awake};
use crate::model::{Fields, Model};

/// How a camera or light moves (mjtCamLight).
mod mode {
    /// Position follows the body, orientation is that at `qpos0`.
    pub(super) const TRACK: i32 = 1;
    /// Position follows the centre of mass of the body's subtree, orientation is that at `qpos0`.
    pub(super) const TRACKCOM: i32 = 2;
    /// Fixed to the body, turned towards the target body.
    pub(super) const TARGETBODY: i32 = 3;
    /// Fixed to the body, turned towards the centre of mass of the target's subtree.
    pub(super) const TARGETBODYCOM: i32 = 4;
}

/// `cam_xpos`, `cam_xmat`.
pub(crate) fn cameras(m: &Model, d: &mut Fields) {
    // Where trees may sleep, nothing that stands is looked at: what it tracks moves away.
    let (sleeping, state) = (asleep::on(m, d), &d.body_awake);
    let (pos, quat) = (rows::<3>(&m.cam_pos), rows::<4>(&m.cam_quat));
    let (xpos, xquat, com) = (rows::<3>(&d.xpos), rows::<4>(&d.xquat), rows::<3>(&d.subtree_com));
    let (out_pos, out_mat) = (rows_mut::<3>(&mut d.cam_xpos), rows_mut::<9>(&mut d.cam_xmat));
    for c in 0..m.ncam {
        let b = m.cam_bodyid[c] as usize;
        out_pos[c] = add(rotate(pos[c], xquat[b]), xpos[b]);
        out_mat[c] = quat_to_mat(quat_mul(xquat[b], quat[c]));
        match m.cam_mode[c] {
            mode::TRACK => {
                out_pos[c] = add(xpos[b], rows::<3>(&m.cam_pos0)[c]);
                out_mat[c] = rows::<9>(&m.cam_mat0)[c];
            }
            mode::TRACKCOM if !(sleeping && state[b] == awake::STATIC) => {
                out_pos[c] = add(com[b], rows::<3>(&m.cam_poscom0)[c]);
                out_mat[c] = rows::<9>(&m.cam_mat0)[c];
            }
            _ => {}
        }
        if let Some(target) = target(m.cam_mode[c], m.cam_targetbodyid[c], xpos, com) {
            out_mat[c] = looking(sub(out_pos[c], target));
        }
    }
}

/// `light_xpos`, `light_xdir`.
pub(crate) fn lights(m: &Model, d: &mut Fields) {
    let (sleeping, state) = (asleep::on(m, d), &d.body_awake);
    let (pos, dir) = (rows::<3>(&m.light_pos), rows::<3>(&m.light_dir));
    let (xpos, xquat, com) = (rows::<3>(&d.xpos), rows::<4>(&d.xquat), rows::<3>(&d.subtree_com));
    let (out_pos, out_dir) = (rows_mut::<3>(&mut d.light_xpos), rows_mut::<3>(&mut d.light_xdir));
    for l in 0..m.nlight {
        let b = m.light_bodyid[l] as usize;
        out_pos[l] = add(rotate(pos[l], xquat[b]), xpos[b]);
        out_dir[l] = rotate(dir[l], xquat[b]);
        match m.light_mode[l] {
            mode::TRACK => {
                out_pos[l] = add(xpos[b], rows::<3>(&m.light_pos0)[l]);
                out_dir[l] = rows::<3>(&m.light_dir0)[l];
            }
            mode::TRACKCOM if !(sleeping && state[b] == awake::STATIC) => {
                out_pos[l] = add(com[b], rows::<3>(&m.light_poscom0)[l]);
                out_dir[l] = rows::<3>(&m.light_dir0)[l];
            }
            _ => {}
        }
        if let Some(target) = target(m.light_mode[l], m.light_targetbodyid[l], xpos, com) {
            out_dir[l] = sub(target, out_pos[l]);
        }
        out_dir[l] = normalize(out_dir[l]).0;
    }
}

/// The point that something looks at.
fn target(kind: i32, body: i32, xpos: &[Vec3], com: &[Vec3]) -> Option<Vec3> {
    let body = usize::try_from(body).ok()?;
    match kind {
        mode::TARGETBODY => xpos.get(body).copied(),
        mode::TARGETBODYCOM => com.get(body).copied(),
        _ => None,
    }
}

/// The frame whose z axis is along `back`, with x level: a camera looks along -z.
fn looking(back: Vec3) -> Mat3 {
    let z = normalize(back).0;
    let x = normalize(cross([0.0, 0.0, 1.0], z)).0;
    let y = normalize(cross(z, x)).0;
    [x[0], y[0], z[0], x[1], y[1], z[1], x[2], y[2], z[2]]
}

/// Where cameras and lights are at the default configuration, relative to what they may follow. The centre of mass
/// is that of the target's subtree where there is a target.
pub(crate) fn set_const(m: &mut Model, d: &Fields) {
    let (xpos, com, xquat) = (rows::<3>(&d.xpos), rows::<3>(&d.subtree_com), rows::<4>(&d.xquat));
    for c in 0..m.ncam {
        let b = m.cam_bodyid[c] as usize;
        let at = add(rotate(rows::<3>(&m.cam_pos)[c], xquat[b]), xpos[b]);
        rows_mut::<3>(&mut m.cam_pos0)[c] = sub(at, xpos[b]);
        rows_mut::<3>(&mut m.cam_poscom0)[c] =
            sub(at, com[usize::try_from(m.cam_targetbodyid[c]).unwrap_or(b)]);
        rows_mut::<9>(&mut m.cam_mat0)[c] = quat_to_mat(quat_mul(xquat[b], rows::<4>(&m.cam_quat)[c]));
    }
    for l in 0..m.nlight {
        let b = m.light_bodyid[l] as usize;
        let at = add(rotate(rows::<3>(&m.light_pos)[l], xquat[b]), xpos[b]);
        rows_mut::<3>(&mut m.light_pos0)[l] = sub(at, xpos[b]);
        rows_mut::<3>(&mut m.light_poscom0)[l] =
            sub(at, com[usize::try_from(m.light_targetbodyid[l]).unwrap_or(b)]);
        rows_mut::<3>(&mut m.light_dir0)[l] = rotate(rows::<3>(&m.light_dir)[l], xquat[b]);
    }
}
