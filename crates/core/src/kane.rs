//! Equations of motion of short chains, by projection onto their degrees of freedom (Kane and Levinson 1985,
//! *Dynamics*, ch. 6).
//!
//! A tree of a few slides and hinges needs no composite inertias and no recursion for forces: with the
//! velocity u_k of a link's centre of mass and its angular velocity w_k for a unit velocity of each degree of
//! freedom k,
//!
//! > M_ik = Σ m u_i·u_k + w_i·(I w_k),   bias_k = Σ u_k·m (a - g) + w_k·(I α + ω × I ω)
//!
//! over the links that k moves, where a and α are the accelerations that the velocities alone cause. A link is
//! what moves with one joint: bodies without joints are part of the link that carries them. Its frame has its
//! origin at the joint's anchor; turning is expressed in it, where I is constant.

use crate::math::*;
use crate::{Data, Model, jacobian, joint};

/// A tree with more degrees of freedom is cheaper by composite bodies and recursion.
const MAX_DOFS: usize = 6;

/// What is written to the model and changes a link.
pub(crate) const FIELDS: [&str; 10] = [
    "body_pos",
    "body_quat",
    "body_ipos",
    "body_iquat",
    "body_mass",
    "body_inertia",
    "jnt_pos",
    "jnt_axis",
    "qpos0",
    "dof_armature",
];

/// The links of all short chains, parents first.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Chains {
    links: Vec<Link>,
    /// Bodies that are part of a link, or that carry one and cannot move, parents first.
    parts: Vec<Part>,
    /// Of each link and each degree of freedom that moves it: w_k and u_k.
    columns: Vec<(Vec3, Vec3)>,
}

/// What moves with one joint.
#[derive(Clone, Debug, Default, PartialEq)]
struct Link {
    joint: usize,
    /// Its degree of freedom, its coordinate, and where its row of M begins.
    dof: usize,
    coordinate: usize,
    row: usize,
    /// The link that it is attached to.
    parent: Option<usize>,
    /// How many links are above it, and where its columns begin.
    depth: usize,
    first: usize,
    slides: bool,
    /// Parameters: see `load`.
    fixed: Fixed,
    /// Where it is.
    pose: Pose,
    /// How it moves.
    motion: Motion,
}

/// What the model says about a link.
#[derive(Clone, Debug, Default, PartialEq)]
struct Fixed {
    /// The link's frame in its parent's, at the default configuration.
    at: Vec3,
    turn: Mat3,
    /// Whether `turn` is the identity.
    straight: bool,
    axis: Vec3,
    reference: f64,
    armature: f64,
    mass: f64,
    /// Centre of mass, and the inertia about it: xx yy zz xy xz yz.
    com: Vec3,
    inertia: [f64; 6],
}

/// Frame, axis of the joint and centre of mass, world.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Pose {
    anchor: Vec3,
    axes: Mat3,
    axis: Vec3,
    com: Vec3,
}

/// Angular velocity and acceleration, and the acceleration of the anchor, for zero joint accelerations.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Motion {
    velocity: Vec3,
    turning: Vec3,
    acceleration: Vec3,
}

/// A body, and its frame in that of its link or of the world.
#[derive(Clone, Debug, Default, PartialEq)]
struct Part {
    body: usize,
    link: Option<usize>,
    /// The part that it is attached to, `None` for the world.
    parent: Option<usize>,
    at: Vec3,
    turn: Mat3,
}

/// Whether a degree of freedom belongs to a short chain: a tree of at most [`MAX_DOFS`] slides and hinges,
/// fixed to the world, that is more than one simple body.
pub(crate) fn covers(m: &Model, dof: usize) -> bool {
    let tree = m.dof_treeid[dof];
    let of_tree = |k: &usize| m.dof_treeid[*k] == tree;
    // The degrees of freedom of a tree are consecutive.
    let first = (0..dof).rev().take_while(of_tree).take(MAX_DOFS).last().unwrap_or(dof);
    let base = m.body_parentid[m.dof_bodyid[first] as usize] as usize;
    let mut dofs = 0;
    m.body_weldid[base] == 0
        && (first..m.nv).take_while(of_tree).take(MAX_DOFS + 1).all(|k| {
            dofs += 1;
            let kind = m.jnt_type[m.dof_jntid[k] as usize];
            dofs <= MAX_DOFS && m.dof_simplenum[k] == 0 && matches!(kind, joint::SLIDE | joint::HINGE)
        })
}

impl Chains {
    /// Finds the short chains of a model.
    pub(crate) fn new(m: &Model) -> Chains {
        let mut chains = Chains::default();
        let mut part_of: Vec<Option<usize>> = vec![None; m.nbody];
        if !(0..m.nv).any(|k| covers(m, k)) {
            return chains;
        }
        for b in 1..m.nbody {
            let last = jacobian::last_dof(m, b);
            let moves = last >= 0;
            if (moves && !covers(m, last as usize)) || (!moves && m.body_weldid[b] != 0) {
                continue;
            }
            let parent = part_of[m.body_parentid[b] as usize];
            let mut link = parent.and_then(|p| chains.parts[p].link);
            for n in 0..m.body_jntnum[b] as usize {
                let joint = m.body_jntadr[b] as usize + n;
                let dof = m.jnt_dofadr[joint] as usize;
                let depth = link.map_or(0, |l| chains.links[l].depth + 1);
                let first = chains.columns.len();
                chains.columns.resize(first + depth + 1, Default::default());
                chains.links.push(Link {
                    joint,
                    dof,
                    coordinate: m.jnt_qposadr[joint] as usize,
                    row: m.M_rowadr[dof] as usize,
                    parent: link,
                    depth,
                    first,
                    slides: m.jnt_type[joint] == joint::SLIDE,
                    ..Link::default()
                });
                link = Some(chains.links.len() - 1);
            }
            part_of[b] = Some(chains.parts.len());
            chains.parts.push(Part { body: b, link, parent, ..Part::default() });
        }
        chains.load(m);
        chains
    }

    /// Takes the parameters of the links from the model.
    pub(crate) fn load(&mut self, m: &Model) {
        let (pos, quat) = (rows::<3>(&m.body_pos), rows::<4>(&m.body_quat));
        let (anchor, axis) = (rows::<3>(&m.jnt_pos), rows::<3>(&m.jnt_axis));
        let mut next = 0;
        for p in 0..self.parts.len() {
            let b = self.parts[p].body;
            let (mut at, mut turn) = (pos[b], quat_to_mat(quat[b]));
            if let Some(parent) = self.parts[p].parent {
                let frame = &self.parts[parent];
                (at, turn) = (add(mat_mul_vec(&frame.turn, at), frame.at), mat_mul(&frame.turn, &turn));
            }
            for _ in 0..m.body_jntnum[b] {
                let link = &mut self.links[next];
                let j = link.joint;
                let f = &mut link.fixed;
                f.at = add(mat_mul_vec(&turn, anchor[j]), at);
                (f.turn, f.straight) = (turn, turn == EYE);
                f.axis = axis[j];
                f.reference = m.qpos0[link.coordinate];
                f.armature = m.dof_armature[link.dof];
                (f.mass, f.com, f.inertia) = (0.0, [0.0; 3], [0.0; 6]);
                // What follows is given in the link's own frame.
                (at, turn) = (scale(anchor[j], -1.0), EYE);
                next += 1;
            }
            (self.parts[p].at, self.parts[p].turn) = (at, turn);
        }

        let (ipos, iquat) = (rows::<3>(&m.body_ipos), rows::<4>(&m.body_iquat));
        let moments = rows::<3>(&m.body_inertia);
        let com = |part: &Part| add(mat_mul_vec(&part.turn, ipos[part.body]), part.at);
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
    }
}

/// I v
#[inline(always)]
fn inertia_turn(i: &[f64; 6], v: Vec3) -> Vec3 {
    [
        i[0] * v[0] + i[3] * v[1] + i[4] * v[2],
        i[3] * v[0] + i[1] * v[1] + i[5] * v[2],
        i[4] * v[0] + i[5] * v[1] + i[2] * v[2],
    ]
}

/// The rows of M that belong to short chains.
#[inline(never)]
pub(crate) fn mass_matrix(m: &Model, d: &mut Data) {
    let chains = &mut d.work.chains;
    if d.plan.chains_may_change {
        chains.load(m);
    }
    for i in 0..chains.links.len() {
        let (above, rest) = chains.links.split_at_mut(i);
        let Some(link) = rest.first_mut() else { return };
        let parent = link.parent.and_then(|p| above.get(p));
        link.place(parent.map(|p| &p.pose), d.qpos[link.coordinate]);
        let (f, pose) = (&link.fixed, &link.pose);

        // From the link's own joint to the root of the tree.
        let columns = &mut chains.columns[link.first..][..link.depth + 1];
        let (mut own, mut up) = (true, &*link);
        for n in (0..columns.len()).rev() {
            columns[n] = match (up.slides, own) {
                (true, _) => ([0.0; 3], up.pose.axis),
                (_, true) => (f.axis, cross(pose.axis, sub(pose.com, pose.anchor))),
                _ => {
                    let turn = mat_t_mul_vec(&pose.axes, up.pose.axis);
                    (turn, cross(up.pose.axis, sub(pose.com, up.pose.anchor)))
                }
            };
            own = false;
            if let Some(parent) = up.parent {
                up = &above[parent];
            }
        }
        let row = &mut d.M[link.row..][..link.depth + 1];
        row.fill(0.0);
        row[link.depth] = f.armature;
        let mut up = &*link;
        for n in (0..columns.len()).rev() {
            let (turn, shift) = columns[n];
            let (spin, push) = (inertia_turn(&f.inertia, turn), scale(shift, f.mass));
            for (out, (w, u)) in d.M[up.row..][..n + 1].iter_mut().zip(columns.iter()) {
                *out += dot(*w, spin) + dot(*u, push);
            }
            if let Some(parent) = up.parent {
                up = &above[parent];
            }
        }
    }
}

impl Link {
    /// The pose for a coordinate of the joint.
    #[inline(always)]
    fn place(&mut self, parent: Option<&Pose>, q: f64) {
        let (f, pose) = (&self.fixed, &mut self.pose);
        match parent {
            None => (pose.anchor, pose.axes) = (f.at, f.turn),
            Some(p) => {
                pose.anchor = add(mat_mul_vec(&p.axes, f.at), p.anchor);
                pose.axes = if f.straight { p.axes } else { mat_mul(&p.axes, &f.turn) };
            }
        }
        pose.axis = mat_mul_vec(&pose.axes, f.axis);
        let displacement = q - f.reference;
        if self.slides {
            pose.anchor = add_scaled(pose.anchor, pose.axis, displacement);
        } else {
            pose.axes = mat_turn(&pose.axes, f.axis, displacement);
        }
        pose.com = add(mat_mul_vec(&pose.axes, f.com), pose.anchor);
    }
}

/// The bias force of short chains.
#[inline(never)]
pub(crate) fn bias(d: &mut Data, gravity: Vec3) {
    let chains = &mut d.work.chains;
    // Gravity enters as an upward acceleration of the world.
    let world = Motion { acceleration: scale(gravity, -1.0), ..Motion::default() };
    for i in 0..chains.links.len() {
        let (above, rest) = chains.links.split_at_mut(i);
        let Some(link) = rest.first_mut() else { return };
        let (f, pose) = (&link.fixed, &link.pose);
        let rate = scale(pose.axis, d.qvel[link.dof]);
        let mut motion = world;
        if let Some(parent) = link.parent.and_then(|p| above.get(p)) {
            motion = parent.motion;
            motion.acceleration = motion.at(sub(pose.anchor, parent.pose.anchor));
            let extra = cross(motion.velocity, rate);
            if link.slides {
                motion.acceleration = add_scaled(motion.acceleration, extra, 2.0);
            } else {
                motion.turning = add(motion.turning, extra);
            }
        }
        if !link.slides {
            motion.velocity = add(motion.velocity, rate);
        }
        let force = scale(motion.at(sub(pose.com, pose.anchor)), f.mass);
        let w = mat_t_mul_vec(&pose.axes, motion.velocity);
        let turning = inertia_turn(&f.inertia, mat_t_mul_vec(&pose.axes, motion.turning));
        let torque = add(turning, cross(w, inertia_turn(&f.inertia, w)));
        link.motion = motion;

        let columns = &chains.columns[link.first..][..link.depth + 1];
        d.qfrc_bias[link.dof] = 0.0;
        let mut up = &*link;
        for (turn, shift) in columns.iter().rev() {
            d.qfrc_bias[up.dof] += dot(*turn, torque) + dot(*shift, force);
            if let Some(parent) = up.parent {
                up = &above[parent];
            }
        }
    }
}

impl Motion {
    /// The acceleration of a point at `arm` from the anchor.
    #[inline(always)]
    fn at(&self, arm: Vec3) -> Vec3 {
        let w = self.velocity;
        add(self.acceleration, add(cross(self.turning, arm), cross(w, cross(w, arm))))
    }
}
