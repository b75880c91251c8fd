//! Rigid bodies: trees in which one body moves, with a ball or a free joint. The position of its centre of mass is
//! arbitrary.
//!
//! Bodies fixed to the moving body move with it as one rigid body. In the axes of the body, the inertia I about the
//! anchor, the first moment h = m r and the mass m are constant. Let R be the orientation of the body, ω its angular
//! velocity in its own axes, and g gravity. For a ball joint
//!
//! > M = I, bias = ω × I ω - h × Rᵀg
//!
//! and for a free joint, whose anchor has the velocity v, additionally
//!
//! > kinetic energy ½ m v² + v · R(ω × h) + ½ ω · I ω, bias along v = R(ω × (ω × h)) - m g

use super::{AlgorithmRow, Assignment, Forces, NOTHING};
use crate::dynamics::{DynamicsScratch, mass as rows_of_mass};
use crate::kinds::joint;
use crate::math::*;
use crate::model::reflect::{FieldId, model as fields_of};
use crate::model::{Fields, Model};

pub(super) const ROW: AlgorithmRow = AlgorithmRow {
    name: "rigid",
    covers,
    copies: &COPIES,
    load: |m, w| w.algorithms.rigid.bodies.iter_mut().for_each(|body| body.load(m)),
    forces: Some(Forces {
        mass,
        bias,
        bias_uses_poses: |_, _| true,
        constant: |_, _| false,
        bias_is_free_torque: false,
    }),
    ..NOTHING
};

/// Fields of the model that determine the inertia of a body.
const COPIES: [FieldId; 10] = [
    fields_of::body_pos,
    fields_of::body_quat,
    fields_of::body_ipos,
    fields_of::body_iquat,
    fields_of::body_mass,
    fields_of::body_inertia,
    fields_of::jnt_pos,
    fields_of::dof_armature,
    fields_of::actuator_armature,
    fields_of::actuator_gear,
];

/// Whether a tree has a single joint: a ball with its three degrees of freedom, or a free joint with its six.
fn covers(m: &Model, tree: usize) -> bool {
    let dofs = m.tree_dofs(tree);
    let kind = m.jnt_type[m.dof_jntid[dofs.start] as usize];
    m.dof_simplenum[dofs.start] == 0 && matches!((kind, dofs.len()), (joint::BALL, 3) | (joint::FREE, 6))
}

/// The bodies of this algorithm.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Trees {
    bodies: Vec<MovingBody>,
}

/// The moving body, with the bodies fixed to it.
#[derive(Clone, Debug, Default, PartialEq)]
struct MovingBody {
    tree: usize,
    body: usize,
    joint: usize,
    /// Whether the joint is free, so that its anchor moves.
    free: bool,
    /// Its first degree of freedom, its first rotational degree of freedom, and the start of its rows of M.
    first: usize,
    turn: usize,
    rows: usize,
    /// Its inertia about the anchor, in its axes: xx yy zz xy xz yz, h, m.
    inertia: [f64; 10],
    /// Armature of the translational and of the rotational degrees of freedom.
    moving: Vec3,
    turning: Vec3,
}

impl Trees {
    pub(super) fn new(m: &Model, assignment: &Assignment) -> Trees {
        let body = |&tree: &usize| {
            let dofs = m.tree_dofs(tree);
            let joint = m.dof_jntid[dofs.start] as usize;
            let mut body = MovingBody {
                tree,
                body: m.jnt_bodyid[joint] as usize,
                joint,
                free: m.jnt_type[joint] == joint::FREE,
                first: dofs.start,
                turn: dofs.end - 3,
                rows: m.M_rowadr[dofs.start] as usize,
                ..MovingBody::default()
            };
            body.load(m);
            body
        };
        Trees { bodies: assignment.forces.iter().map(body).collect() }
    }
}

impl MovingBody {
    /// Reads its inertia and armature from the model.
    fn load(&mut self, m: &Model) {
        let first = m.tree_bodyadr[self.tree] as usize;
        let bodies = first..first + m.tree_bodynum[self.tree] as usize;
        self.inertia = bodies.fold([0.0; 10], |sum, b| add(sum, self.inertia_of(m, b)));
        let armature = |first: usize| [0, 1, 2].map(|i| rows_of_mass::armature(m, first + i));
        (self.moving, self.turning) = (armature(self.first), armature(self.turn));
    }

    /// The inertia of body `b`, which is the moving body or fixed to it, about the anchor.
    fn inertia_of(&self, m: &Model, mut b: usize) -> [f64; 10] {
        let (mass, moments) = (m.body_mass[b], rows::<3>(&m.body_inertia)[b]);
        let (mut position, mut axes) = (rows::<3>(&m.body_ipos)[b], quat_to_mat(rows::<4>(&m.body_iquat)[b]));
        while b != self.body {
            let frame = quat_to_mat(quat_normalize(rows::<4>(&m.body_quat)[b]));
            position = add(mat_mul_vec(&frame, position), rows::<3>(&m.body_pos)[b]);
            axes = mat_mul(&frame, &axes);
            b = m.body_parentid[b] as usize;
        }
        inertia_about(moments, &axes, sub(position, self.anchor(m)), mass)
    }

    /// The anchor in the frame of the body. For a free joint it is the origin.
    fn anchor(&self, m: &Model) -> Vec3 {
        if self.free { [0.0; 3] } else { rows::<3>(&m.jnt_pos)[self.joint] }
    }
}

fn mass(_: &Model, d: &mut Fields, w: &mut DynamicsScratch) {
    for body in &w.algorithms.rigid.bodies {
        let [xx, yy, zz, xy, xz, yz, hx, hy, hz, mass] = body.inertia;
        let ([a, b, c], [u, v, w]) = (body.turning, body.moving);
        let out = &mut d.M[body.rows..];
        if !body.free {
            fill(out, [xx + a, xy, yy + b, xz, yz, zz + c]);
            continue;
        }
        // R(ω × h) for a unit angular velocity about each axis.
        let axes = &rows::<9>(&d.xmat)[body.body];
        let [x, y, z] = [[0.0, -hz, hy], [hz, 0.0, -hx], [-hy, hx, 0.0]].map(|push| mat_mul_vec(axes, push));
        #[rustfmt::skip]
        fill(out, [
            mass + u,
            0.0, mass + v,
            0.0, 0.0, mass + w,
            x[0], x[1], x[2], xx + a,
            y[0], y[1], y[2], xy, yy + b,
            z[0], z[1], z[2], xz, yz, zz + c,
        ]);
    }
}

/// Overwrites the first N numbers of consecutive rows.
fn fill<const N: usize>(rows: &mut [f64], values: [f64; N]) {
    if let Some(rows) = rows.first_chunk_mut() {
        *rows = values;
    }
}

fn bias(_: &Model, d: &mut Fields, w: &mut DynamicsScratch, gravity: Vec3) {
    for body in &w.algorithms.rigid.bodies {
        let [xx, yy, zz, xy, xz, yz, hx, hy, hz, mass] = body.inertia;
        let (h, axes) = ([hx, hy, hz], &rows::<9>(&d.xmat)[body.body]);
        let Some(&turn) = d.qvel[body.turn..].first_chunk() else {
            return broken_invariant("a body that turns has three angular velocities");
        };
        let [x, y, z] = turn;
        let momentum = [xx * x + xy * y + xz * z, xy * x + yy * y + yz * z, xz * x + yz * y + zz * z];
        let torque = sub(cross(turn, momentum), cross(h, mat_t_mul_vec(axes, gravity)));
        fill(&mut d.qfrc_bias[body.turn..], torque);
        if body.free {
            let outward = mat_mul_vec(axes, cross(turn, cross(turn, h)));
            fill(&mut d.qfrc_bias[body.first..], add_scaled(outward, gravity, -mass));
        }
    }
}
