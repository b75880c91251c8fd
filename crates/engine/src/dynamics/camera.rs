//! Poses of cameras and lights, which can track a body or be directed at one.

use crate::kinds::camlight;
use crate::math::*;
use crate::model::asleep::{self, awake};
use crate::model::{Fields, Model};

/// `cam_xpos`, `cam_xmat`.
pub(crate) fn cameras(m: &Model, d: &mut Fields) {
    for c in 0..m.ncam {
        let b = m.cam_bodyid[c] as usize;
        let (position, turn) = (rows::<3>(&d.xpos)[b], rows::<4>(&d.xquat)[b]);
        rows_mut::<3>(&mut d.cam_xpos)[c] = add(rotate(rows::<3>(&m.cam_pos)[c], turn), position);
        rows_mut::<9>(&mut d.cam_xmat)[c] = quat_to_mat(quat_mul(turn, rows::<4>(&m.cam_quat)[c]));
        if m.cam_mode[c] != camlight::FIXED {
            move_camera(m, d, c, b);
        }
    }
}

/// Pose of camera `c` on body `b` if it tracks a body or is directed at one.
#[inline(never)] // most cameras are fixed
fn move_camera(m: &Model, d: &mut Fields, c: usize, b: usize) {
    let is_static = is_static(m, d, b);
    let (xpos, com) = (rows::<3>(&d.xpos), rows::<3>(&d.subtree_com));
    let pos = &mut rows_mut::<3>(&mut d.cam_xpos)[c];
    let mat = &mut rows_mut::<9>(&mut d.cam_xmat)[c];
    match m.cam_mode[c] {
        camlight::TRACK => {
            *pos = add(xpos[b], rows::<3>(&m.cam_pos0)[c]);
            *mat = rows::<9>(&m.cam_mat0)[c];
        }
        camlight::TRACKCOM if !is_static => {
            *pos = add(com[b], rows::<3>(&m.cam_poscom0)[c]);
            *mat = rows::<9>(&m.cam_mat0)[c];
        }
        _ => {}
    }
    if let Some(target) = target(m.cam_mode[c], m.cam_targetbodyid[c], xpos, com) {
        *mat = frame_of_back_axis(sub(*pos, target));
    }
}

/// `light_xpos`, `light_xdir`.
pub(crate) fn lights(m: &Model, d: &mut Fields) {
    for l in 0..m.nlight {
        let b = m.light_bodyid[l] as usize;
        let (position, turn) = (rows::<3>(&d.xpos)[b], rows::<4>(&d.xquat)[b]);
        rows_mut::<3>(&mut d.light_xpos)[l] = add(rotate(rows::<3>(&m.light_pos)[l], turn), position);
        rows_mut::<3>(&mut d.light_xdir)[l] = rotate(rows::<3>(&m.light_dir)[l], turn);
        if m.light_mode[l] != camlight::FIXED {
            move_light(m, d, l, b);
        }
        let dir = &mut rows_mut::<3>(&mut d.light_xdir)[l];
        *dir = normalize(*dir).0;
    }
}

/// Pose of light `l` on body `b` if it tracks a body or is directed at one.
#[inline(never)] // most lights are fixed
fn move_light(m: &Model, d: &mut Fields, l: usize, b: usize) {
    let is_static = is_static(m, d, b);
    let (xpos, com) = (rows::<3>(&d.xpos), rows::<3>(&d.subtree_com));
    let pos = &mut rows_mut::<3>(&mut d.light_xpos)[l];
    let dir = &mut rows_mut::<3>(&mut d.light_xdir)[l];
    match m.light_mode[l] {
        camlight::TRACK => {
            *pos = add(xpos[b], rows::<3>(&m.light_pos0)[l]);
            *dir = rows::<3>(&m.light_dir0)[l];
        }
        camlight::TRACKCOM if !is_static => {
            *pos = add(com[b], rows::<3>(&m.light_poscom0)[l]);
            *dir = rows::<3>(&m.light_dir0)[l];
        }
        _ => {}
    }
    if let Some(target) = target(m.light_mode[l], m.light_targetbodyid[l], xpos, com) {
        *dir = sub(target, *pos);
    }
}

/// Whether sleep is enabled and body `b` is static. Static bodies are then not updated, so their cameras and lights
/// do not follow a moving centre of mass.
fn is_static(m: &Model, d: &Fields, b: usize) -> bool {
    asleep::on(m, d) && d.body_awake[b] == awake::STATIC
}

/// The point at which a camera or light is directed.
fn target(kind: i32, body: i32, xpos: &[Vec3], com: &[Vec3]) -> Option<Vec3> {
    let body = usize::try_from(body).ok()?;
    match kind {
        camlight::TARGETBODY => xpos.get(body).copied(),
        camlight::TARGETBODYCOM => com.get(body).copied(),
        _ => None,
    }
}

/// The frame whose z axis is along `back`, with a horizontal x axis. A camera looks along -z.
fn frame_of_back_axis(back: Vec3) -> Mat3 {
    let z = normalize(back).0;
    let x = normalize(cross([0.0, 0.0, 1.0], z)).0;
    let y = normalize(cross(z, x)).0;
    [x[0], y[0], z[0], x[1], y[1], z[1], x[2], y[2], z[2]]
}

/// Computes the poses of cameras and lights in the default configuration, relative to what they can track. The centre
/// of mass is that of the subtree of the target body, if there is one.
pub fn set_const(m: &mut Model, d: &Fields) {
    let (xpos, com, xquat) = (rows::<3>(&d.xpos), rows::<3>(&d.subtree_com), rows::<4>(&d.xquat));
    for c in 0..m.ncam {
        let b = m.cam_bodyid[c] as usize;
        let position = add(rotate(rows::<3>(&m.cam_pos)[c], xquat[b]), xpos[b]);
        rows_mut::<3>(&mut m.cam_pos0)[c] = sub(position, xpos[b]);
        rows_mut::<3>(&mut m.cam_poscom0)[c] =
            sub(position, com[usize::try_from(m.cam_targetbodyid[c]).unwrap_or(b)]);
        rows_mut::<9>(&mut m.cam_mat0)[c] = quat_to_mat(quat_mul(xquat[b], rows::<4>(&m.cam_quat)[c]));
    }
    for l in 0..m.nlight {
        let b = m.light_bodyid[l] as usize;
        let position = add(rotate(rows::<3>(&m.light_pos)[l], xquat[b]), xpos[b]);
        rows_mut::<3>(&mut m.light_pos0)[l] = sub(position, xpos[b]);
        rows_mut::<3>(&mut m.light_poscom0)[l] =
            sub(position, com[usize::try_from(m.light_targetbodyid[l]).unwrap_or(b)]);
        rows_mut::<3>(&mut m.light_dir0)[l] = rotate(rows::<3>(&m.light_dir)[l], xquat[b]);
    }
}
