//! Momentum of subtrees (`mj_subtreeVel`).
//!
//! The angular momentum of a system about its centre of mass is the sum of the angular momenta of its parts about
//! their centres of mass and those of the motion of the parts relative to the system: L = Σ Lᵢ + mᵢ (cᵢ - c) × (vᵢ -
//! v).

use crate::math::*;
use crate::model::{Fields, Model};

/// `subtree_linvel`, `subtree_angmom` of every body with its descendants, world frame. Requires `cvel`.
pub fn subtree_vel(m: &Model, d: &mut Fields) {
    let (xipos, com) = (rows::<3>(&d.xipos), rows::<3>(&d.subtree_com));
    let (ximat, cvel) = (rows::<9>(&d.ximat), rows::<6>(&d.cvel));
    let inertia = rows::<3>(&m.body_inertia);
    let (linvel, angmom) = (rows_mut::<3>(&mut d.subtree_linvel), rows_mut::<3>(&mut d.subtree_angmom));

    // `linvel` holds momenta until all descendants are added, then velocities.
    for i in 0..m.nbody {
        linvel[i] = scale(body_velocity(m, i, xipos, com, cvel), m.body_mass[i]);
        let w = mat_t_mul_vec(&ximat[i], angular(&cvel[i]));
        let turning = std::array::from_fn(|k| inertia[i][k] * w[k]);
        angmom[i] = mat_mul_vec(&ximat[i], turning);
    }
    for i in (0..m.nbody).rev() {
        if i > 0 {
            let parent = m.body_parentid[i] as usize;
            linvel[parent] = add(linvel[parent], linvel[i]);
        }
        linvel[i] = scale(linvel[i], 1.0 / m.body_subtreemass[i].max(MINVAL));
    }
    for i in (0..m.nbody).rev() {
        // Adds the motion of the body relative to its subtree, and that of the subtree relative to the subtree of the
        // parent.
        let v = sub(body_velocity(m, i, xipos, com, cvel), linvel[i]);
        angmom[i] = add(angmom[i], scale(cross(sub(xipos[i], com[i]), v), m.body_mass[i]));
        if i > 0 {
            let parent = m.body_parentid[i] as usize;
            let (dx, dv) = (sub(com[i], com[parent]), sub(linvel[i], linvel[parent]));
            let drift = scale(cross(dx, dv), m.body_subtreemass[i]);
            angmom[parent] = add(angmom[parent], add(angmom[i], drift));
        }
    }
}

/// Velocity of the centre of mass of body `i`.
fn body_velocity(m: &Model, i: usize, xipos: &[Vec3], com: &[Vec3], cvel: &[Spatial]) -> Vec3 {
    let arm = sub(xipos[i], com[m.body_rootid[i] as usize]);
    add(linear(&cvel[i]), cross(angular(&cvel[i]), arm))
}
