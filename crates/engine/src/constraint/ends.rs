//! Equality constraints: completion of their data for `mj_setConst`, the points where they act, and the force and
//! torque of their rows.
//!
//! `eq_data` of a constraint between bodies. For `connect`: the anchor in the frame of the first body (0..3) and in
//! that of the second (3..6). For `weld`: the anchor in the frame of the second body (0..3), position (3..6) and
//! orientation (6..10) of the second body relative to the first, and the ratio of torque to force.
//!
//! A connect constrains two points, a weld two frames. The rotational rows of a weld are the vector part of q₂⁻¹ q₁
//! q_rel times that ratio. A force f along them is therefore the torque ½ q₂ f (q₁ q_rel)⁻¹ on body 1, by the
//! transpose of the map from angular velocities to their rate (MuJoCo's documentation, chapter "Computation", section
//! on equality).

use crate::dynamics::object;
use crate::kinds::eqtype;
use crate::math::*;
use crate::model::index::object_index;
use crate::model::{Fields, Model, Obj};

/// Length of a row of `eq_data`.
const DATA: usize = 11;

/// Completes `eq_data`, with `d` in the default configuration: the anchor of `connect` in the frame of the second
/// body, and the relative pose of a `weld` that does not specify one.
pub fn set_const(m: &mut Model, d: &Fields) {
    let (xpos, xmat, xquat) = (rows::<3>(&d.xpos), rows::<9>(&d.xmat), rows::<4>(&d.xquat));
    for i in 0..m.neq {
        if m.eq_objtype[i] != Obj::Body as i32 {
            continue;
        }
        let [b1, b2] = [m.eq_obj1id[i], m.eq_obj2id[i]].map(|b| b as usize);
        let data = &mut rows_mut::<DATA>(&mut m.eq_data)[i];
        let anchor = [data[0], data[1], data[2]];
        // Transforms the anchor from the frame of one body to that of another.
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

/// One end of a constraint: its body, the constrained point, and for a weld the orientation, world frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ConstraintEnd {
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

/// Both ends of a connect or weld. Returns `None` for constraints of joints and tendons.
pub(crate) fn ends(m: &Model, d: &Fields, e: usize) -> Option<[ConstraintEnd; 2]> {
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
            Some(ConstraintEnd { body: f.body, point: f.pos, quat })
        };
        return Some([end(ids[0])?, end(ids[1])?]);
    }
    // The data of a weld contain the anchor on body 2 first, then the pose of body 2 in body 1.
    let (first, second) = ([data[0], data[1], data[2]], [data[3], data[4], data[5]]);
    let anchors = if weld { [second, first] } else { [first, second] };
    let relative = if weld { [data[6], data[7], data[8], data[9]] } else { IDENTITY };
    let end = |id: usize, anchor: Vec3, relative: Quat| {
        let f = object::frame(m, d, Obj::XBody as i32, id)?;
        let quat = if weld { quat_mul(*rows(&d.xquat).get(id)?, relative) } else { IDENTITY };
        Some(ConstraintEnd { body: id, point: add(f.pos, mat_mul_vec(&f.mat, anchor)), quat })
    };
    Some([end(ids[0], anchors[0], relative)?, end(ids[1], anchors[1], IDENTITY)?])
}

/// Force and torque on body 1, in world axes, for the forces `rows` of a constraint with the ends `ends`. Those on
/// body 2 are opposite; each acts at the point of its own end.
pub(crate) fn wrench(m: &Model, e: usize, ends: &[ConstraintEnd; 2], rows: &[f64]) -> (Vec3, Vec3) {
    let (Some(&force), turn) = (rows.first_chunk::<3>(), rows.get(3..)) else { return ([0.0; 3], [0.0; 3]) };
    let Some(&f) = turn.and_then(|t| t.first_chunk::<3>()) else { return (force, [0.0; 3]) };
    let torquescale = m.eq_data[DATA * e + 10];
    let [_, x, y, z] = quat_mul(quat_mul(ends[1].quat, [0.0, f[0], f[1], f[2]]), quat_conj(ends[0].quat));
    (force, scale([x, y, z], 0.5 * torquescale))
}
