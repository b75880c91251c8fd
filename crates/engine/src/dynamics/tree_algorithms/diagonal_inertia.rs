//! Simple bodies: the only body of their tree, with their inertia along their own axes.
//!
//! M is diagonal and constant. The bias force has a closed form: weight for translations, ω × I ω for rotations.

use super::{AlgorithmRow, Assignment, Forces, NOTHING};
use crate::dynamics::DynamicsScratch;
use crate::kinds::joint;
use crate::math::*;
use crate::model::reflect::model as fields_of;
use crate::model::{Fields, Model};
use std::ops::Range;

pub(super) const ROW: AlgorithmRow = AlgorithmRow {
    name: "diagonal_inertia",
    covers,
    copies: &[fields_of::body_mass, fields_of::body_inertia],
    load: |m, w| w.algorithms.diagonal_inertia.joints.iter_mut().for_each(|joint| joint.load(m)),
    forces: Some(Forces {
        mass,
        bias,
        bias_uses_poses: slides,
        constant: has_inertia,
        bias_is_free_torque: true,
    }),
    ..NOTHING
};

/// Whether a tree consists of a simple body.
fn covers(m: &Model, tree: usize) -> bool {
    m.tree_dofs(tree).all(|dof| m.dof_simplenum[dof] > 0)
}

/// Whether M is constant. A tree without inertia is factorized in every step nevertheless, because this causes a
/// warning.
fn has_inertia(m: &Model, tree: usize) -> bool {
    m.tree_dofs(tree).all(|dof| m.dof_M0[dof] >= MINVAL)
}

/// Whether the bias force depends on poses: the weight acts along the axes of slides.
fn slides(m: &Model, tree: usize) -> bool {
    m.tree_dofs(tree).any(|dof| m.jnt_type[m.dof_jntid[dof] as usize] == joint::SLIDE)
}

/// Joints and degrees of freedom of the simple bodies.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Trees {
    joints: Vec<SimpleJoint>,
    dofs: Vec<Range<usize>>,
}

impl Trees {
    pub(super) fn new(m: &Model, assignment: &Assignment) -> Trees {
        let dofs: Vec<_> = assignment.forces.iter().map(|&tree| m.tree_dofs(tree)).collect();
        let mut joints: Vec<usize> =
            dofs.iter().cloned().flatten().map(|dof| m.dof_jntid[dof] as usize).collect();
        joints.dedup();
        Trees { joints: joints.into_iter().map(|joint| SimpleJoint::new(m, joint)).collect(), dofs }
    }
}

/// Copies the constant diagonal.
fn mass(m: &Model, d: &mut Fields, w: &mut DynamicsScratch) {
    for i in w.algorithms.diagonal_inertia.dofs.iter().cloned().flatten() {
        d.M[m.M_rowadr[i] as usize] = m.dof_M0[i];
    }
}

/// A joint of a simple body.
#[derive(Clone, Copy, Debug, PartialEq)]
struct SimpleJoint {
    joint: usize,
    kind: i32,
    body: usize,
    dof: usize,
    /// Mass of the body, and its moments of inertia along its own axes.
    mass: f64,
    inertia: Vec3,
}

impl SimpleJoint {
    fn new(m: &Model, joint: usize) -> SimpleJoint {
        let body = m.jnt_bodyid[joint] as usize;
        let (kind, dof) = (m.jnt_type[joint], m.jnt_dofadr[joint] as usize);
        let mut joint = SimpleJoint { joint, kind, body, dof, mass: 0.0, inertia: [0.0; 3] };
        joint.load(m);
        joint
    }

    fn load(&mut self, m: &Model) {
        (self.mass, self.inertia) = (m.body_mass[self.body], rows::<3>(&m.body_inertia)[self.body]);
    }
}

#[cfg_attr(not(feature = "small"), inline(always))]
fn bias(_: &Model, d: &mut Fields, w: &mut DynamicsScratch, gravity: Vec3) {
    for joint in &w.algorithms.diagonal_inertia.joints {
        bias_of(d, joint, gravity);
    }
}

/// The Jacobian, by rows, of ω × I ω with respect to ω, for a body with its inertia along its own axes.
pub(crate) fn gyroscopic_jacobian([a, b, c]: Vec3, [x, y, z]: Vec3) -> [Vec3; 3] {
    [[0.0, (c - b) * z, (c - b) * y], [(a - c) * z, 0.0, (a - c) * x], [(b - a) * y, (b - a) * x, 0.0]]
}

/// Computes the bias force for one joint of a simple body: weight for translations, ω × I ω in the frame of the body
/// for rotations. It is zero for a hinge, which rotates about a principal axis.
#[cfg_attr(not(feature = "small"), inline(always))]
fn bias_of(d: &mut Fields, s: &SimpleJoint, gravity: Vec3) {
    let (mass, [a, b, c]) = (s.mass, s.inertia);
    let turning = |w: Vec3| cross(w, [a * w[0], b * w[1], c * w[2]]);
    let (Some(v), Some(out)) = (d.qvel.get(s.dof..), d.qfrc_bias.get_mut(s.dof..)) else {
        return broken_invariant("a joint has a velocity and a force");
    };
    match (s.kind, v, out) {
        (joint::FREE, &[_, _, _, x, y, z, ..], [fx, fy, fz, tx, ty, tz, ..]) => {
            [*fx, *fy, *fz] = scale(gravity, -mass);
            [*tx, *ty, *tz] = turning([x, y, z]);
        }
        (joint::SLIDE, _, [out, ..]) => {
            let axis = d.xaxis.get(3 * s.joint..).and_then(|axes| axes.first_chunk());
            *out = axis.map_or(0.0, |axis| -mass * dot(gravity, *axis));
        }
        (joint::HINGE, _, [out, ..]) => *out = 0.0,
        (joint::BALL, &[x, y, z, ..], [tx, ty, tz, ..]) => [*tx, *ty, *tz] = turning([x, y, z]),
        _ => {}
    }
}
