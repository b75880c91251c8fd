//! Accelerations of bodies and the forces on them, computed after the constraint forces (`mj_rnePostConstraint`).
//!
//! Recursive Newton–Euler algorithm (Featherstone 2008, section 5.3): accelerations from the root to the leaves, then
//! the force between each body and its parent from the leaves to the root. All spatial quantities are about the
//! centre of mass of the tree.

use super::tension;
use crate::constraint::{self, ends};
use crate::kinds::disable;
use crate::math::*;
use crate::model::{Fields, Model};

/// Computes `cacc`, `cfrc_ext` and `cfrc_int`. Requires `qacc` and the constraint forces.
///
/// Gravity is included as an upward acceleration of the world, so a body at rest has the acceleration that an
/// accelerometer at rest measures.
pub fn rne_post_constraint(m: &Model, d: &mut Fields) {
    external(m, d);
    let gravity = if m.opt.disabled(disable::GRAVITY) { [0.0; 3] } else { m.opt.gravity };
    let (cdof, cdof_dot) = (rows::<6>(&d.cdof), rows::<6>(&d.cdof_dot));
    let (cinert, cvel, cfrc_ext) = (rows::<10>(&d.cinert), rows::<6>(&d.cvel), rows::<6>(&d.cfrc_ext));
    let (cacc, cfrc_int) = (rows_mut::<6>(&mut d.cacc), rows_mut::<6>(&mut d.cfrc_int));

    cacc[0] = [0.0, 0.0, 0.0, -gravity[0], -gravity[1], -gravity[2]];
    cfrc_int[0] = [0.0; 6];
    for i in 1..m.nbody {
        let mut a = cacc[m.body_parentid[i] as usize];
        let first = m.body_dofadr[i];
        for k in first as usize..(first + m.body_dofnum[i]) as usize {
            a = add_scaled(a, cdof_dot[k], d.qvel[k]);
            a = add_scaled(a, cdof[k], d.qacc[k]);
        }
        cacc[i] = a;
        let momentum = inertia_mul(&cinert[i], &cvel[i]);
        let needed = add(inertia_mul(&cinert[i], &a), cross_force(&cvel[i], &momentum));
        cfrc_int[i] = sub(needed, cfrc_ext[i]);
    }
    for i in (1..m.nbody).rev() {
        let parent = m.body_parentid[i] as usize;
        cfrc_int[parent] = add(cfrc_int[parent], cfrc_int[i]);
    }
}

/// Computes `cfrc_ext`: forces applied to bodies, and those of equality constraints, contacts and spatial tendons.
fn external(m: &Model, d: &mut Fields) {
    let mut cfrc_ext = std::mem::take(&mut d.cfrc_ext);
    let out = rows_mut::<6>(&mut cfrc_ext);
    out.fill([0.0; 6]);
    let com = rows::<3>(&d.subtree_com);
    // Adds a force and a torque at a point; those on the world body are ignored.
    let mut apply = |body: usize, point: Vec3, force: Vec3, torque: Vec3| {
        if body > 0 {
            let t = add(torque, cross(sub(point, com[m.body_rootid[body] as usize]), force));
            out[body] = add(out[body], [t[0], t[1], t[2], force[0], force[1], force[2]]);
        }
    };
    for (i, f) in rows::<6>(&d.xfrc_applied).iter().enumerate() {
        if *f != [0.0; 6] {
            apply(i, rows::<3>(&d.xipos)[i], [f[0], f[1], f[2]], [f[3], f[4], f[5]]);
        }
    }
    // Rows of equality constraints come first.
    let mut row = 0;
    while row < d.nefc && d.efc_type[row] == constraint::kind::EQUALITY {
        let e = d.efc_id[row] as usize;
        let end = (row + ends::rows_of(m, e)).min(d.nefc);
        if let Some(ends) = ends::ends(m, d, e) {
            let (force, torque) = ends::wrench(m, e, &ends, &d.efc_force[row..end]);
            apply(ends[0].body, ends[0].point, force, torque);
            apply(ends[1].body, ends[1].point, scale(force, -1.0), scale(torque, -1.0));
        }
        row = end;
    }
    for c in d.contact.iter().filter(|c| c.efc_address.is_some()) {
        let f = constraint::contact_force(m, d, c);
        let force = mat_t_mul_vec(&c.frame, [f[0], f[1], f[2]]);
        let torque = mat_t_mul_vec(&c.frame, [f[3], f[4], f[5]]);
        apply(m.geom_bodyid[c.geom1] as usize, c.pos, scale(force, -1.0), scale(torque, -1.0));
        apply(m.geom_bodyid[c.geom2] as usize, c.pos, force, torque);
    }
    tension::for_each_pull(m, d, |body, point, force| apply(body, point, force, [0.0; 3]));
    d.cfrc_ext = cfrc_ext;
}
