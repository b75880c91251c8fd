//! Equality constraints: what `mj_setConst` completes of their data.
//!
//! `eq_data` of a constraint between bodies: for `connect` the anchor in the first body's frame (0..3) and in
//! the second's (3..6); for `weld` the anchor in the second body's frame (0..3), position (3..6) and orientation
//! (6..10) of the second relative to the first; then the ratio of torque to force.

use crate::math::*;
use crate::{Data, Model, Obj, eqtype};

/// Numbers of a constraint in `eq_data`.
const DATA: usize = 11;

/// Completes `eq_data`, with `d` at the default configuration: the anchor of `connect` in the second body's
/// frame, and the relative pose of a `weld` that has none.
pub(crate) fn set_const(m: &mut Model, d: &Data) {
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
