//! Equality constraints: what `mj_setConst` completes of their data, where they act, and which force and torque
//! their rows mean.
//!
//! `eq_data` of a constraint between bodies: for `connect` the anchor in the first body's frame (0..3) and in
//! the second's (3..6); for `weld` the anchor in the second body's frame (0..3), position (3..6) and orientation
//! (6..10) of the second relative to the first; then the ratio of torque to force.
//!
//! A connect holds two points together, a weld two frames. The rotation rows of a weld are the vector part of
//! q₂⁻¹ q₁ q_rel times that ratio, so a force f along them is the torque ½ q₂ f (q₁ q_rel)⁻¹ on body 1: the transpose
//! of how angular velocity changes them (MuJoCo's documentation, chapter "Computation", section on equality).

use crate::dynamics::object;
use crate::kinds::eqtype;
use crate::math::*;
use crate::model::index::object_index;
use crate::model::{Fields, Model, Obj};

/// Numbers of a constraint in `eq_data`.
const DATA: usize = 11;

/// Completes `eq_data`, with `d` at the default configuration: the anchor of `connect` in the second body's
/// frame, and the relative pose of a `weld` that has none.
pub fn set_const(m: &mut Model, d: &Fields) {
    let (xpos, xmat, xquat) = (rows::<3>(&d.xpos), rows::<9>(&d.xmat), rows::<4>(&d.xquat));
    for i in 0..m.neq {
        if m.eq_objtype[i] != Obj::Body as i32 {
            continue;
        }
        let [b1, b2] = [m.eq_obj1id[i], m.eq_obj2id[i]].map(|b| b as usize);
        let data = &mut rows_mut::<DATA>(&mut m.eq_data)[i];
        let anchor = [data[0], data[1], data[2]];
        // The anchor, given in one body's frame, in the other's.
        let moved = |from: usize, to: usize| {
            let world = add(mat_mul_vec(&xmat[from], anchor), xpos[from]);
            mat_t_mul_vec(&xmat[to], sub(world, xpos[to]))
        };
        match m.eq_type[i] {
            eqtype::CONNECT => data[3..6].copy_from_slice(&moved(b1, b2)),
            eqtype::WELD => {
                let quat = [data[6], data[7], data[8], data[9]];
                if quat == [0.0; 4] {
                    data[3..6].copy_from_slice(&moved(b2, b1));
                    data[6..10].copy_from_slice(&quat_mul(quat_conj(xquat[b1]), xquat[b2]));
                } else {
                    data[6..10].copy_from_slice(&quat_normalize(quat));
                }
            }
            _ => {}
        }
    }
}

/// One end of a constraint: its body, the point that is held, and, of a weld, the orientation, world.
#[derive(Clone, Copy, Debug)]
pub(crate) struct End {
    pub(crate) body: usize,
    pub(crate) point: Vec3,
    pub(crate) quat: Quat,
}

/// Number of rows of an equality constraint.
pub(crate) fn rows_of(m: &Model, e: usize) -> usize {
    match m.eq_type.get(e) {
        Some(&eqtype::CONNECT) => 3,
        Some(&eqtype::WELD) => 6,
        _ => 1,
    }
}

/// Both ends of a connect or weld. `None` for constraints of joints and tendons.
pub(crate) fn ends(m: &Model, d: &Fields, e: usize) -> Option<[End; 2]> {
    let data = rows::<DATA>(&m.eq_data).get(e)?;
    let weld = m.eq_type[e] == eqtype::WELD;
    if !weld && m.eq_type[e] != eqtype::CONNECT {
        return None;
    }
    let ids = [m.eq_obj1id[e], m.eq_obj2id[e]].map(object_index);
    if m.eq_objtype[e] == Obj::Site as i32 {
        let end = |id: usize| {
            let f = object::frame(m, d, Obj::Site as i32, id)?;
            let quat = if weld { object::orientation(m, d, Obj::Site as i32, id)? } else { IDENTITY };
            Some(End { body: f.body, point: f.pos, quat })
        };
        return Some([end(ids[0])?, end(ids[1])?]);
    }
    // A weld lists the anchor on body 2 first, then the pose of body 2 in body 1.
    let (first, second) = ([data[0], data[1], data[2]], [data[3], data[4], data[5]]);
    let anchors = if weld { [second, first] } else { [first, second] };
    let relative = if weld { [data[6], data[7], data[8], data[9]] } else { IDENTITY };
    let end = |id: usize, anchor: Vec3, relative: Quat| {
        let f = object::frame(m, d, Obj::XBody as i32, id)?;
        let quat = if weld { quat_mul(*rows(&d.xquat).get(id)?, relative) } else { IDENTITY };
        Some(End { body: id, point: add(f.pos, mat_mul_vec(&f.mat, anchor)), quat })
    };
    Some([end(ids[0], anchors[0], relative)?, end(ids[1], anchors[1], IDENTITY)?])
}

/// Force and torque on body 1 of the rows of a constraint with ends `ends`, world; those on body 2 are opposite,
/// each at its own point.
pub(crate) fn wrench(m: &Model, e: usize, ends: &[End; 2], rows: &[f64]) -> (Vec3, Vec3) {
    let (Some(&force), turn) = (rows.first_chunk::<3>(), rows.get(3..)) else { return ([0.0; 3], [0.0; 3]) };
    let Some(&f) = turn.and_then(|t| t.first_chunk::<3>()) else { return (force, [0.0; 3]) };
    let torquescale = m.eq_data[DATA * e + 10];
    let [_, x, y, z] = quat_mul(quat_mul(ends[1].quat, [0.0, f[0], f[1], f[2]]), quat_conj(ends[0].quat));
    (force, scale([x, y, z], 0.5 * torquescale))
}
