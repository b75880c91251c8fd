//! `qfrc_bias`: gravity, Coriolis and centrifugal forces.

use crate::dynamics::DynamicsScratch;
use crate::kinds::disable;
use crate::math::{lanes, *};
use crate::model::index::element_range;
use crate::model::{Fields, Model};

/// `qfrc_bias` of all bodies.
#[inline(never)]
pub(crate) fn newton_euler(m: &Model, d: &mut Fields, w: &mut DynamicsScratch, gravity: Vec3) {
    let mut out = std::mem::take(&mut d.qfrc_bias);
    recursion(m, d, w, gravity, None, &mut out);
    d.qfrc_bias = out;
}

/// The generalized force (nv) that causes the acceleration `qacc` (nv) (`mj_rne`). Without `qacc` the acceleration is
/// zero, and the result consists of gravity, Coriolis and centrifugal forces. The inertia of joints (armature) is not
/// included. Returns `None` if an array is too short.
///
/// Requires the position and velocity stages of a full pipeline.
pub fn rne(
    m: &Model,
    d: &mut Fields,
    w: &mut DynamicsScratch,
    qacc: Option<&[f64]>,
    out: &mut [f64],
) -> Option<()> {
    if out.len() < m.nv || qacc.is_some_and(|a| a.len() < m.nv) {
        return None;
    }
    let gravity = if m.opt.disabled(disable::GRAVITY) { [0.0; 3] } else { m.opt.gravity };
    recursion(m, d, w, gravity, qacc, out);
    Some(())
}

/// The generalized force for an acceleration (Featherstone 2008, section 5.3). Gravity is included as an upward
/// acceleration of the world.
fn recursion(
    m: &Model,
    d: &mut Fields,
    w: &mut DynamicsScratch,
    gravity: Vec3,
    qacc: Option<&[f64]>,
    out: &mut [f64],
) {
    let cdof = rows::<6>(&d.cdof);
    let cdof_dot = rows::<6>(&d.cdof_dot);
    let (cinert, cvel) = (rows::<10>(&d.cinert), rows::<6>(&d.cvel));
    let cacc = rows_mut::<6>(&mut w.cacc);
    let cfrc = rows_mut::<6>(&mut w.cfrc);

    cacc[0] = [0.0, 0.0, 0.0, -gravity[0], -gravity[1], -gravity[2]];
    cfrc[0] = [0.0; 6];
    for i in 1..m.nbody {
        let mut a = [0.0; 6];
        let dofs = element_range(m.body_dofadr[i], m.body_dofnum[i]);
        for (s, &v) in cdof_dot[dofs.clone()].iter().zip(&d.qvel[dofs.clone()]) {
            a = add_scaled(a, *s, v);
        }
        if let Some(qacc) = qacc {
            for k in dofs {
                a = add_scaled(a, cdof[k], qacc[k]);
            }
        }
        cacc[i] = add(cacc[m.body_parentid[i] as usize], a);
    }
    for four in lanes::by_fours(m.nbody) {
        let (inertia, v) = (lanes::gather(cinert, four), lanes::gather(cvel, four));
        let force = inertia_mul(&inertia, &lanes::gather(cacc, four));
        let turning = cross_force(&v, &inertia_mul(&inertia, &v));
        lanes::scatter(add(force, turning), cfrc, four);
    }
    for i in (1..m.nbody).rev() {
        let parent = m.body_parentid[i] as usize;
        cfrc[parent] = add(cfrc[parent], cfrc[i]);
    }
    for ((out, s), &body) in out.iter_mut().zip(cdof).zip(&m.dof_bodyid) {
        *out = dot(*s, cfrc[body as usize]);
    }
}
