//! Centres of mass, and inertias, motion axes and velocities relative to them.
//!
//! All spatial quantities of a kinematic tree are expressed about the centre of mass of the tree (`subtree_com` of
//! its root), in world axes. This avoids cancellation far from the origin.

use crate::kinds::joint;
use crate::math::{lanes, *};
use crate::model::plan::PlanFlag;
use crate::model::{Fields, Model};

/// `subtree_com`, `cinert`, `cdof`.
#[inline(never)]
pub fn com_pos(m: &Model, d: &mut Fields) {
    subtree_com(m, d);
    if d.plan.has(PlanFlag::BodyInertias) {
        body_inertias(m, d);
    }
    motion_axes(m, d);
}

/// `cinert`: spatial inertias of bodies about the centre of mass of their tree.
pub(crate) fn body_inertias(m: &Model, d: &mut Fields) {
    let com = rows::<3>(&d.subtree_com);
    let (xipos, ximat) = (rows::<3>(&d.xipos), rows::<9>(&d.ximat));
    let moments = rows::<3>(&m.body_inertia);
    let cinert = rows_mut::<10>(&mut d.cinert);
    cinert[0] = [0.0; 10];
    for four in lanes::by_fours(m.nbody) {
        let roots = four.map(|i| m.body_rootid[i] as usize);
        let offset = sub(lanes::gather(xipos, four), lanes::gather(com, roots));
        let (moments, axes) = (lanes::gather(moments, four), lanes::gather(ximat, four));
        let mass = lanes::gather_one(&m.body_mass, four);
        lanes::scatter(inertia_about(moments, &axes, offset, mass), cinert, four);
    }
}

/// `cdof`: the motion axis of each degree of freedom, as a spatial velocity about the centre of mass of the tree.
fn motion_axes(m: &Model, d: &mut Fields) {
    let com = rows::<3>(&d.subtree_com);
    let (xanchor, xaxis, xmat) = (rows::<3>(&d.xanchor), rows::<3>(&d.xaxis), rows::<9>(&d.xmat));
    let cdof = rows_mut::<6>(&mut d.cdof);
    let joints = m.jnt_type.iter().zip(&m.jnt_bodyid).zip(&m.jnt_dofadr);
    for (((&kind, &body), &first), (&anchor, &axis)) in joints.zip(xanchor.iter().zip(xaxis)) {
        let (body, mut k) = (body as usize, first as usize);
        let to_com = sub(com[m.body_rootid[body] as usize], anchor);
        let turning = |axis: Vec3| -> Spatial {
            let l = cross(axis, to_com);
            [axis[0], axis[1], axis[2], l[0], l[1], l[2]]
        };
        match kind {
            joint::SLIDE => cdof[k] = [0.0, 0.0, 0.0, axis[0], axis[1], axis[2]],
            joint::HINGE => cdof[k] = turning(axis),
            kind => {
                if kind == joint::FREE {
                    for i in 0..3 {
                        cdof[k] = [0.0; 6];
                        cdof[k][3 + i] = 1.0;
                        k += 1;
                    }
                }
                // Three hinge axes along the axes of the body.
                for i in 0..3 {
                    cdof[k + i] = turning(column(&xmat[body], i));
                }
            }
        }
    }
}

fn subtree_com(m: &Model, d: &mut Fields) {
    let xipos = rows::<3>(&d.xipos);
    let com = rows_mut::<3>(&mut d.subtree_com);
    for i in 0..m.nbody {
        com[i] = scale(xipos[i], m.body_mass[i]);
    }
    // The sum of the body at hand. In a chain, the next body adds to it.
    let mut sum = com[m.nbody - 1];
    for i in (1..m.nbody).rev() {
        let parent = m.body_parentid[i] as usize;
        let of_parent = add(com[parent], sum);
        com[parent] = of_parent;
        sum = if parent == i - 1 { of_parent } else { com[i - 1] };
    }
    for i in 0..m.nbody {
        let mass = m.body_subtreemass[i];
        com[i] = if mass < MINVAL { xipos[i] } else { scale(com[i], 1.0 / mass.max(MINVAL)) };
    }
}

/// `cvel`, `cdof_dot`.
#[inline(never)]
pub(crate) fn com_vel(m: &Model, d: &mut Fields) {
    let cdof = rows::<6>(&d.cdof);
    let (cvel, cdof_dot) = (rows_mut::<6>(&mut d.cvel), rows_mut::<6>(&mut d.cdof_dot));
    let qvel = &d.qvel;
    cvel[0] = [0.0; 6];
    // The velocity of the body at hand. In a chain, the next body starts from it.
    let mut v = [0.0; 6];
    for i in 1..m.nbody {
        let parent = m.body_parentid[i] as usize;
        if parent != i - 1 {
            v = cvel[parent];
        }
        let first = m.body_jntadr[i];
        for j in first as usize..(first + m.body_jntnum[i]) as usize {
            let mut k = m.jnt_dofadr[j] as usize;
            match m.jnt_type[j] {
                joint::SLIDE | joint::HINGE => {
                    cdof_dot[k] = cross_motion(&v, &cdof[k]);
                    v = add_scaled(v, cdof[k], qvel[k]);
                }
                kind => {
                    if kind == joint::FREE {
                        // World axes do not rotate.
                        for i in 0..3 {
                            cdof_dot[k] = [0.0; 6];
                            v[3 + i] += qvel[k];
                            k += 1;
                        }
                    }
                    // The three axes rotate together, so all use the velocity before the joint.
                    let before = v;
                    for _ in 0..3 {
                        cdof_dot[k] = cross_motion(&before, &cdof[k]);
                        v = add_scaled(v, cdof[k], qvel[k]);
                        k += 1;
                    }
                }
            }
        }
        cvel[i] = v;
    }
}
