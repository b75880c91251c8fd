//! The derivative of the bias force (gravity, Coriolis and centrifugal force) with respect to velocities.
//!
//! For a unit velocity of degree of freedom j, every body that it moves gains the velocity s_j and the acceleration p_j + s_j ×
//! v, where s_j is the motion axis, v the body's velocity, p_j = ṡ_j - s_j × v_j, and v_j the velocity after joint j. Its force
//! changes by I (p_j + s_j × v) + v ×* I s_j + s_j ×* I v. This is linear in p_j and s_j. Therefore the inertias, and the
//! matrices B that multiply s_j, can be summed over subtrees, like composite bodies (Featherstone 2008, chapter 6; Echeandia and
//! Wensing 2021, *Numerical methods to compute the Coriolis matrix*).

use crate::model::index::element_range;
use std::ops::Range;

use super::sparse;
use crate::kinds::joint;
use crate::math::*;
use crate::model::{Fields, Model};

/// The columns of a spatial matrix.
type Columns = [Spatial; 6];

/// The sums over subtrees, and p_j of every degree of freedom.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct BiasSums {
    inertia: Vec<Inertia>,
    matrix: Vec<Columns>,
    slope: Vec<Spatial>,
}

impl BiasSums {
    pub(super) fn resize(&mut self, m: &Model) {
        self.inertia.resize(m.nbody, [0.0; 10]);
        self.matrix.resize(m.nbody, [[0.0; 6]; 6]);
        self.slope.resize(m.nv, [0.0; 6]);
    }
}

/// out ← out - ∂`qfrc_bias`/∂`qvel` for whole trees, given their bodies and degrees of freedom.
pub(super) fn subtract(
    m: &Model,
    d: &Fields,
    w: &mut BiasSums,
    bodies: Range<usize>,
    dofs: Range<usize>,
    out: &mut [f64],
) {
    composite(m, d, w, bodies.clone());
    slopes(m, d, w, bodies);
    let cdof = rows::<6>(&d.cdof);
    for i in dofs {
        let body = m.dof_bodyid[i] as usize;
        let (inertia, matrix) = (&w.inertia[body], &w.matrix[body]);
        // The change of the force of the subtree of i along s_i: from p_j, and from s_j.
        let from_slope = inertia_mul(inertia, &cdof[i]);
        let from_axis: Spatial = std::array::from_fn(|c| dot(matrix[c], cdof[i]));
        // The change of the force of the subtree for a unit velocity of i.
        let mut force = inertia_mul(inertia, &w.slope[i]);
        for c in 0..6 {
            force = add_scaled(force, matrix[c], cdof[i][c]);
        }
        for (a, &j) in sparse::ancestors(m, i).iter().enumerate() {
            let j = j as usize;
            let (lower, upper) = sparse::pair(m, i, j, a);
            out[lower] -= dot(from_slope, w.slope[j]) + dot(from_axis, cdof[j]);
            out[upper] -= dot(cdof[j], force);
        }
        out[sparse::diagonal(m, i)] -= dot(cdof[i], force);
    }
}

/// Inertias and matrices B of all bodies, summed over subtrees.
fn composite(m: &Model, d: &Fields, w: &mut BiasSums, bodies: Range<usize>) {
    let (cinert, cvel) = (rows::<10>(&d.cinert), rows::<6>(&d.cvel));
    for b in bodies.clone() {
        w.inertia[b] = cinert[b];
        w.matrix[b] = matrix(&cinert[b], &cvel[b]);
    }
    let first = bodies.start;
    for b in bodies.rev() {
        let parent = m.body_parentid[b] as usize;
        if parent < first {
            continue;
        }
        w.inertia[parent] = add(w.inertia[parent], w.inertia[b]);
        for c in 0..6 {
            w.matrix[parent][c] = add(w.matrix[parent][c], w.matrix[b][c]);
        }
    }
}

/// B s = I (s × v) + v ×* I s + s ×* I v.
fn matrix(inertia: &Inertia, v: &Spatial) -> Columns {
    let momentum = inertia_mul(inertia, v);
    std::array::from_fn(|c| {
        let mut s = [0.0; 6];
        s[c] = 1.0;
        let turned = inertia_mul(inertia, &cross_motion(&s, v));
        let carried = cross_force(v, &inertia_mul(inertia, &s));
        add(add(turned, carried), cross_force(&s, &momentum))
    })
}

/// p_j of all degrees of freedom.
fn slopes(m: &Model, d: &Fields, w: &mut BiasSums, bodies: Range<usize>) {
    let (cdof, cdof_dot) = (rows::<6>(&d.cdof), rows::<6>(&d.cdof_dot));
    let cvel = rows::<6>(&d.cvel);
    for b in bodies {
        let mut v = cvel[m.body_parentid[b] as usize];
        for j in element_range(m.body_jntadr[b], m.body_jntnum[b]) {
            let k = m.jnt_dofadr[j] as usize;
            // Groups of degrees of freedom that move together: the translations and the rotations of a free joint, a ball joint.
            let groups = match m.jnt_type[j] {
                joint::FREE => [k..k + 3, k + 3..k + 6],
                joint::BALL => [k..k, k..k + 3],
                _ => [k..k, k..k + 1],
            };
            for group in groups {
                for k in group.clone() {
                    v = add_scaled(v, cdof[k], d.qvel[k]);
                }
                for k in group {
                    w.slope[k] = sub(cdof_dot[k], cross_motion(&cdof[k], &v));
                }
            }
        }
    }
}
