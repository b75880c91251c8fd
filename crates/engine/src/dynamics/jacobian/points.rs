//! Jacobians of points and bodies as dense matrices for users (`mj_jac` and related functions).
//!
//! Jacobians are those of the configuration of the last position stage; their derivatives use the velocities of the
//! last velocity stage. Rows correspond to world axes, columns to degrees of freedom.

use super::dof_motion;
use crate::dynamics::walk::moving;
use crate::kinds::joint;
use crate::math::*;
use crate::model::{Fields, Model};

/// The velocities of a point and of the body that it is fixed to, for a unit velocity of each degree of freedom.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Jacobian {
    /// Velocity of the point: `[3, nv]`, row-major.
    pub jacp: Vec<f64>,
    /// Angular velocity of the body: `[3, nv]`, row-major.
    pub jacr: Vec<f64>,
}

impl Jacobian {
    fn zero(m: &Model) -> Jacobian {
        Jacobian { jacp: vec![0.0; 3 * m.nv], jacr: vec![0.0; 3 * m.nv] }
    }

    fn add(&mut self, m: &Model, dof: usize, turn: Vec3, shift: Vec3) {
        for axis in 0..3 {
            self.jacp[axis * m.nv + dof] += shift[axis];
            self.jacr[axis * m.nv + dof] += turn[axis];
        }
    }
}

/// The Jacobian of a point of a body, given in world coordinates, m (`mj_jac`). Returns `None` if the body does not
/// exist.
pub fn jac(m: &Model, d: &Fields, point: Vec3, body: usize) -> Option<Jacobian> {
    let mut out = Jacobian::zero(m);
    if body >= m.nbody {
        return None;
    }
    for k in moving(m, body) {
        let (turn, shift) = dof_motion(m, d, k, point);
        out.add(m, k, turn, shift);
    }
    Some(out)
}

/// The Jacobian of the origin of a body frame (`mj_jacBody`).
pub fn jac_body(m: &Model, d: &Fields, body: usize) -> Option<Jacobian> {
    jac(m, d, *rows::<3>(&d.xpos).get(body)?, body)
}

/// The Jacobian of the centre of mass of a body (`mj_jacBodyCom`).
pub fn jac_body_com(m: &Model, d: &Fields, body: usize) -> Option<Jacobian> {
    jac(m, d, *rows::<3>(&d.xipos).get(body)?, body)
}

/// The Jacobian of the origin of a geom frame (`mj_jacGeom`).
pub fn jac_geom(m: &Model, d: &Fields, geom: usize) -> Option<Jacobian> {
    jac(m, d, *rows::<3>(&d.geom_xpos).get(geom)?, *m.geom_bodyid.get(geom)? as usize)
}

/// The Jacobian of the origin of a site frame (`mj_jacSite`).
pub fn jac_site(m: &Model, d: &Fields, site: usize) -> Option<Jacobian> {
    jac(m, d, *rows::<3>(&d.site_xpos).get(site)?, *m.site_bodyid.get(site)? as usize)
}

/// `[3, nv]`: the Jacobian of the centre of mass of a body and all its descendants (`mj_jacSubtreeCom`). Returns
/// `None` if the body does not exist.
pub fn jac_subtree_com(m: &Model, d: &Fields, body: usize) -> Option<Vec<f64>> {
    let mut out = Jacobian::zero(m);
    if body >= m.nbody {
        return None;
    }
    let mut within = vec![false; m.nbody];
    for b in body..m.nbody {
        within[b] = b == body || b > 0 && within[m.body_parentid[b] as usize];
        if within[b] && m.body_mass[b] != 0.0 {
            for k in moving(m, b) {
                let (_, shift) = dof_motion(m, d, k, rows::<3>(&d.xipos)[b]);
                out.add(m, k, [0.0; 3], scale(shift, m.body_mass[b]));
            }
        }
    }
    let total = m.body_subtreemass[body].max(MINVAL);
    out.jacp.iter_mut().for_each(|x| *x /= total);
    Some(out.jacp)
}

/// The time derivative of the Jacobian of a point that moves with a body (`mj_jacDot`): the acceleration of the point
/// is J q̈ + J̇ q̇. Returns `None` if the body does not exist.
pub fn jac_dot(m: &Model, d: &Fields, point: Vec3, body: usize) -> Option<Jacobian> {
    let mut out = Jacobian::zero(m);
    if body >= m.nbody {
        return None;
    }
    let com = rows::<3>(&d.subtree_com)[m.body_rootid[body] as usize];
    let (cdof, cdof_dot, cvel) = (rows::<6>(&d.cdof), rows::<6>(&d.cdof_dot), rows::<6>(&d.cvel));
    let arm = sub(point, com);
    let velocity = add(linear(&cvel[body]), cross(angular(&cvel[body]), arm));
    for k in moving(m, body) {
        let j = m.dof_jntid[k] as usize;
        let turns = matches!(m.jnt_type[j], joint::BALL | joint::FREE);
        let world = m.jnt_type[j] == joint::FREE && k < m.jnt_dofadr[j] as usize + 3;
        // The axes of ball joints, and the rotation axes of free joints, are fixed to the body and rotate with it.
        let rate = if turns && !world {
            cross_motion(&cvel[m.jnt_bodyid[j] as usize], &cdof[k])
        } else {
            cdof_dot[k]
        };
        let shift = add(linear(&rate), cross(angular(&rate), arm));
        out.add(m, k, angular(&rate), add(shift, cross(angular(&cdof[k]), velocity)));
    }
    Some(out)
}

/// Adds to `qfrc` (nv) the generalized force of a force (N) at a point of a body and a torque (N m), all in world
/// axes (`mj_applyFT`). Returns `None` if the body does not exist or `qfrc` is too short.
pub fn apply_ft(
    m: &Model,
    d: &Fields,
    force: Vec3,
    torque: Vec3,
    point: Vec3,
    body: usize,
    qfrc: &mut [f64],
) -> Option<()> {
    if body >= m.nbody || qfrc.len() < m.nv {
        return None;
    }
    super::apply(m, d, body, point, force, torque, qfrc);
    Some(())
}
