//! Equations of motion of short chains, by projection onto their degrees of freedom (Kane and Levinson 1985,
//! *Dynamics*, ch. 6).
//!
//! A tree of a few slides and hinges needs no composite inertias and no recursion for forces. For each link and each
//! degree of freedom k, let u_k be the velocity of the centre of mass and w_k the angular velocity for a unit
//! velocity of k. Then
//!
//! > M_ik = Σ m u_i·u_k + w_i·(I w_k),   bias_k = Σ u_k·m (a - g) + w_k·(I α + ω × I ω)
//!
//! summed over the links that k moves, where a and α are the accelerations for zero joint accelerations. A link
//! consists of the bodies that move with one joint: bodies without joints belong to the link that carries them. The
//! frame of a link has its origin at the anchor of its joint. Rotational terms are expressed in this frame, where I
//! is constant. For a chain that moves in a plane, the same equations are used in two dimensions.

mod planar;
mod spatial;
#[cfg(test)]
mod tests;

use super::{AlgorithmRow, Assignment, Forces, NOTHING};
pub(super) use planar::plane_of;

use crate::dynamics::{DynamicsScratch, mass, walk};
use crate::kinds::joint;
use crate::math::*;
use crate::model::reflect::{FieldId, model as fields_of};
use crate::model::{Fields, Model};

/// Maximum number of degrees of freedom. For larger trees, composite bodies and recursion are faster.
const MAX_DOFS: usize = 6;

pub(super) const ROW: AlgorithmRow = AlgorithmRow {
    name: "chain",
    covers,
    copies: &COPIES,
    load: |m, w| w.algorithms.chain.load(m),
    forces: Some(Forces {
        mass,
        bias,
        bias_uses_poses: |_, _| false,
        constant: |_, _| false,
        bias_is_free_torque: false,
    }),
    ..NOTHING
};

/// Fields of the model that determine the parameters of links.
pub(super) const COPIES: [FieldId; 12] = [
    fields_of::body_pos,
    fields_of::body_quat,
    fields_of::body_ipos,
    fields_of::body_iquat,
    fields_of::body_mass,
    fields_of::body_inertia,
    fields_of::jnt_pos,
    fields_of::jnt_axis,
    fields_of::qpos0,
    fields_of::dof_armature,
    fields_of::actuator_armature,
    fields_of::actuator_gear,
];

/// The links of all short chains, chain by chain, each starting at its root.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Trees {
    links: Vec<ChainLink>,
    /// Number of links of each chain.
    lengths: Vec<usize>,
    /// Bodies that belong to a link, or that carry one and cannot move. Parents come first.
    parts: Vec<LinkBody>,
}

/// The bodies that move with one joint.
#[derive(Clone, Debug, Default, PartialEq)]
struct ChainLink {
    joint: usize,
    dof: usize,
    /// Index of its coordinate in `qpos`.
    coordinate: usize,
    /// Start of its row of M.
    row: usize,
    slides: bool,
    /// Parameters from the model: see `load`.
    fixed: LinkParameters,
    /// Whether the chain moves in a plane. If so, the next field holds the parameters in the plane.
    planar: bool,
    flat: planar::PlanarLinkParameters,
    swing: planar::Swing,
    /// Its current pose, for spatial chains.
    pose: LinkPose,
    /// w_k and u_k of each degree of freedom that moves it, starting at the root.
    columns: [(Vec3, Vec3); MAX_DOFS],
}

/// Parameters of a link from the model.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct LinkParameters {
    /// Pose of its frame in that of its parent, in the default configuration.
    pub(super) position: Vec3,
    pub(super) turn: Mat3,
    /// Whether `turn` is the identity.
    straight: bool,
    pub(super) axis: Vec3,
    pub(super) reference: f64,
    pub(super) armature: f64,
    pub(super) mass: f64,
    /// Centre of mass, and the inertia about it: xx yy zz xy xz yz.
    pub(super) com: Vec3,
    inertia: [f64; 6],
    /// Whether the link has neither mass nor inertia, as all but the last joint of a body: its forces are zero.
    massless: bool,
}

impl LinkParameters {
    /// The moment of inertia about an axis through the centre of mass.
    pub(super) fn moment(&self, n: Vec3) -> f64 {
        let [xx, yy, zz, xy, xz, yz] = self.inertia;
        let rows = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
        dot(n, rows.map(|row| dot(row, n)))
    }
}

/// Frame, joint axis and centre of mass of a link, world frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct LinkPose {
    anchor: Vec3,
    axes: Mat3,
    axis: Vec3,
    com: Vec3,
}

/// Angular velocity and acceleration, and the acceleration of the anchor, for zero joint accelerations.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct LinkMotion {
    velocity: Vec3,
    turning: Vec3,
    acceleration: Vec3,
}

/// A body, and its pose in the frame of its link or of the world.
#[derive(Clone, Debug, Default, PartialEq)]
struct LinkBody {
    body: usize,
    link: Option<usize>,
    /// The index in `parts` of its parent, `None` for the world.
    parent: Option<usize>,
    position: Vec3,
    turn: Mat3,
}

/// Whether a tree is a short chain: at most [`MAX_DOFS`] slides and hinges in series, starting at the world, that are
/// not a simple body.
fn covers(m: &Model, tree: usize) -> bool {
    let dofs = m.tree_dofs(tree);
    let first = dofs.start;
    let link = |k: usize| {
        let serial = k == first || m.dof_parentid[k] == k as i32 - 1;
        let kind = m.jnt_type[m.dof_jntid[k] as usize];
        serial && m.dof_simplenum[k] == 0 && matches!(kind, joint::SLIDE | joint::HINGE)
    };
    let on_the_world = |k: usize| m.body_weldid[m.body_parentid[m.dof_bodyid[k] as usize] as usize] == 0;
    dofs.len() <= MAX_DOFS && dofs.clone().all(link) && on_the_world(first)
}

impl Trees {
    /// Finds the links of the short chains of a model.
    pub(super) fn new(m: &Model, assignment: &Assignment) -> Trees {
        let mut chains = Trees::default();
        let mut part_of: Vec<Option<usize>> = vec![None; m.nbody];
        if assignment.forces.is_empty() {
            return chains;
        }
        let is_own = |dof: usize| assignment.forces.contains(&(m.dof_treeid[dof] as usize));
        for b in 1..m.nbody {
            let last = walk::last_dof(m, b);
            let moves = last >= 0;
            if (moves && !is_own(last as usize)) || (!moves && m.body_weldid[b] != 0) {
                continue;
            }
            let parent = part_of[m.body_parentid[b] as usize];
            let mut link = parent.and_then(|p| chains.parts[p].link);
            for n in 0..m.body_jntnum[b] as usize {
                let joint = m.body_jntadr[b] as usize + n;
                let dof = m.jnt_dofadr[joint] as usize;
                match chains.lengths.last_mut() {
                    Some(length) if link.is_some() => *length += 1,
                    _ => chains.lengths.push(1),
                }
                chains.links.push(ChainLink {
                    joint,
                    dof,
                    coordinate: m.jnt_qposadr[joint] as usize,
                    row: m.M_rowadr[dof] as usize,
                    slides: m.jnt_type[joint] == joint::SLIDE,
                    ..ChainLink::default()
                });
                link = Some(chains.links.len() - 1);
            }
            part_of[b] = Some(chains.parts.len());
            chains.parts.push(LinkBody { body: b, link, parent, ..LinkBody::default() });
        }
        chains.load(m);
        chains
    }

    /// The parameters of each link, and the index of its coordinate in `qpos`.
    pub(super) fn parameters(&self) -> impl Iterator<Item = (&LinkParameters, usize)> {
        self.links.iter().map(|link| (&link.fixed, link.coordinate))
    }

    /// Reads the parameters of the links from the model.
    pub(super) fn load(&mut self, m: &Model) {
        let (pos, quat) = (rows::<3>(&m.body_pos), rows::<4>(&m.body_quat));
        let (anchor, axis) = (rows::<3>(&m.jnt_pos), rows::<3>(&m.jnt_axis));
        let mut next = 0;
        for p in 0..self.parts.len() {
            let b = self.parts[p].body;
            let (mut position, mut turn) = (pos[b], quat_to_mat(quat[b]));
            if let Some(parent) = self.parts[p].parent {
                let frame = &self.parts[parent];
                (position, turn) =
                    (add(mat_mul_vec(&frame.turn, position), frame.position), mat_mul(&frame.turn, &turn));
            }
            for _ in 0..m.body_jntnum[b] {
                let link = &mut self.links[next];
                let j = link.joint;
                let f = &mut link.fixed;
                f.position = add(mat_mul_vec(&turn, anchor[j]), position);
                (f.turn, f.straight) = (turn, turn == EYE);
                f.axis = axis[j];
                f.reference = m.qpos0[link.coordinate];
                f.armature = mass::armature(m, link.dof);
                (f.mass, f.com, f.inertia) = (0.0, [0.0; 3], [0.0; 6]);
                // The following joints and bodies are given in the frame of this link.
                (position, turn) = (scale(anchor[j], -1.0), EYE);
                next += 1;
            }
            (self.parts[p].position, self.parts[p].turn) = (position, turn);
        }

        let (ipos, iquat) = (rows::<3>(&m.body_ipos), rows::<4>(&m.body_iquat));
        let moments = rows::<3>(&m.body_inertia);
        let com = |part: &LinkBody| add(mat_mul_vec(&part.turn, ipos[part.body]), part.position);
        for part in &self.parts {
            let Some(link) = part.link else { continue };
            let (f, mass) = (&mut self.links[link].fixed, m.body_mass[part.body]);
            f.mass += mass;
            f.com = add_scaled(f.com, sub(com(part), f.com), if f.mass > 0.0 { mass / f.mass } else { 0.0 });
        }
        for part in &self.parts {
            let Some(link) = part.link else { continue };
            let (f, b) = (&mut self.links[link].fixed, part.body);
            let axes = mat_mul(&part.turn, &quat_to_mat(iquat[b]));
            let [xx, yy, zz, xy, xz, yz, ..] =
                inertia_about(moments[b], &axes, sub(com(part), f.com), m.body_mass[b]);
            f.inertia = add(f.inertia, [xx, yy, zz, xy, xz, yz]);
        }
        for link in &mut self.links {
            link.fixed.massless = link.fixed.mass == 0.0 && link.fixed.inertia == [0.0; 6];
        }
        let mut rest = self.links.as_mut_slice();
        for &n in &self.lengths {
            let (chain, after) = rest.split_at_mut(n);
            planar::load(chain);
            rest = after;
        }
    }
}

/// The number of links of a chain: the constant N, or the actual length if N is 0.
#[cfg_attr(not(feature = "small"), inline(always))]
fn length<const N: usize>(chain: &[ChainLink]) -> usize {
    if N == 0 { chain.len().min(MAX_DOFS) } else { N }
}

/// Calls a function for each chain with its length as a constant, so that loops are unrolled. With the feature
/// `small`, one instance serves all lengths.
macro_rules! by_length {
    ($chains:expr, $function:ident($($argument:expr),*)) => {{
        let mut rest = $chains.links.as_mut_slice();
        for &n in &$chains.lengths {
            let (chain, after) = rest.split_at_mut(n);
            let constant = if cfg!(feature = "small") { 0 } else { n };
            match (constant, chain[0].planar) {
                (0, true) => planar::$function::<0>(chain, $($argument),*),
                (1, true) => planar::$function::<1>(chain, $($argument),*),
                (2, true) => planar::$function::<2>(chain, $($argument),*),
                (3, true) => planar::$function::<3>(chain, $($argument),*),
                (4, true) => planar::$function::<4>(chain, $($argument),*),
                (5, true) => planar::$function::<5>(chain, $($argument),*),
                (_, true) => planar::$function::<MAX_DOFS>(chain, $($argument),*),
                (0, _) => spatial::$function::<0>(chain, $($argument),*),
                (1, _) => spatial::$function::<1>(chain, $($argument),*),
                (2, _) => spatial::$function::<2>(chain, $($argument),*),
                (3, _) => spatial::$function::<3>(chain, $($argument),*),
                (4, _) => spatial::$function::<4>(chain, $($argument),*),
                (5, _) => spatial::$function::<5>(chain, $($argument),*),
                _ => spatial::$function::<MAX_DOFS>(chain, $($argument),*),
            }
            rest = after;
        }
    }};
}

/// Computes the rows of M of short chains.
fn mass(_: &Model, d: &mut Fields, w: &mut DynamicsScratch) {
    by_length!(w.algorithms.chain, mass_matrix(&d.qpos, &mut d.M));
}

/// Computes the bias force of short chains.
#[inline(never)] // so that scenes without such chains do not execute its setup code
fn bias(_: &Model, d: &mut Fields, w: &mut DynamicsScratch, gravity: Vec3) {
    by_length!(w.algorithms.chain, bias(&d.qvel, &mut d.qfrc_bias, gravity));
}
