//! Simple bodies: alone in their tree, with their inertia along their own axes.
//!
//! M is diagonal and constant, the bias force has a closed form: weight along translations, ω × I ω for rotations.

use crate::kinds::joint;
use crate::math::*;
use crate::model::{Fields, Model};

/// Whether a degree of freedom belongs to one. One without inertia is left to the general way, which warns of it.
pub(crate) fn covers(m: &Model, dof: usize) -> bool {
    m.dof_simplenum[dof] > 0 && m.dof_M0[dof] >= MINVAL
}

/// Whether one of them has no inertia: a plan that was made when it had some does not look.
pub(crate) fn lacks_inertia(m: &Model) -> bool {
    (0..m.nv).any(|dof| m.dof_simplenum[dof] > 0 && m.dof_M0[dof] < MINVAL)
}

/// The constant diagonal of simple bodies in M.
pub(crate) fn mass_matrix(m: &Model, d: &mut Fields) {
    for i in 0..m.nv {
        if m.dof_simplenum[i] > 0 {
            d.M[m.M_rowadr[i] as usize] = m.dof_M0[i];
        }
    }
}

/// The diagonal of M as the model knows it, for a scene whose bodies are all simple: M is constant.
pub(crate) fn constant(m: &Model, d: &mut Fields) {
    d.M.copy_from_slice(&m.dof_M0);
    d.qLD.copy_from_slice(&m.dof_M0);
    for i in 0..m.nv {
        d.qLDiagInv[i] = 1.0 / m.dof_M0[i];
    }
}

/// A joint of a simple body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Joint {
    joint: usize,
    kind: i32,
    body: usize,
    dof: usize,
}

/// The joints of simple bodies.
pub(crate) fn joints(m: &Model) -> Vec<Joint> {
    let joint = |joint: usize| {
        let body = m.jnt_bodyid[joint] as usize;
        Joint { joint, kind: m.jnt_type[joint], body, dof: m.jnt_dofadr[joint] as usize }
    };
    (0..m.njnt).map(joint).filter(|s| m.body_simple[s.body] > 0).collect()
}

/// One joint of a simple body: weight along translations, ω × I ω for rotations in the body's frame. A
/// hinge turns about a principal axis and feels nothing.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(super) fn bias(m: &Model, d: &mut Fields, s: &Joint, gravity: Vec3) {
    let (Some(mass), Some(&[a, b, c])) = (m.body_mass.get(s.body), rows::<3>(&m.body_inertia).get(s.body))
    else {
        return;
    };
    let turning = |w: Vec3| cross(w, [a * w[0], b * w[1], c * w[2]]);
    let (Some(v), Some(out)) = (d.qvel.get(s.dof..), d.qfrc_bias.get_mut(s.dof..)) else { return };
    match (s.kind, v, out) {
        (joint::FREE, &[_, _, _, x, y, z, ..], [fx, fy, fz, tx, ty, tz, ..]) => {
            [*fx, *fy, *fz] = scale(gravity, -mass);
            [*tx, *ty, *tz] = turning([x, y, z]);
        }
        (joint::SLIDE, _, [out, ..]) => *out = -mass * dot(gravity, rows::<3>(&d.xaxis)[s.joint]),
        (joint::HINGE, _, [out, ..]) => *out = 0.0,
        (joint::BALL, &[x, y, z, ..], [tx, ty, tz, ..]) => [*tx, *ty, *tz] = turning([x, y, z]),
        _ => {}
    }
}
