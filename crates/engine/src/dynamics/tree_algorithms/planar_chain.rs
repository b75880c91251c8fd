//! Long planar chains: many hinges in series, starting at the world, with parallel axes.
//!
//! In a plane a velocity has three components, one angular and two linear, and so has a force. The bias force is
//! computed by recursion (Featherstone 2008, chapter 5) and accelerations by articulated bodies (chapter 7: see
//! `articulated`), each about the anchor of the hinge itself. The articulated inertia of a body with its descendants
//! about an anchor is
//!
//! > | J  hᵀ |
//! > | h  M  |
//!
//! with the moment of inertia J, the first moment h (2) and the mass M (2 x 2). Let r be the vector from the previous
//! anchor to this one, and q = (-r_y, r_x). A rotation about the previous anchor with angular velocity ω moves this
//! anchor at ω q. About the previous anchor, the first moment is h + M q, and the moment of inertia is J + q · (2 h +
//! M q).
//!
//! Which trees are such chains is determined when a model is compiled, and stored in the model. If axes or frames are
//! written afterwards, a chain may no longer be planar. It is then computed by the general algorithm.

use super::planar_passes::{PlanarJoint, PlanarLink, forward_kinematics, inward, outward, solve_known};
use super::{AlgorithmRow, Assignment, Damped, Factors, Forces, NOTHING, chain};
use crate::dynamics::{DynamicsScratch, com, kinematics, mass as rows_of_m, reflected, rne};
use crate::kinds::joint;
use crate::math::*;
use crate::model::plan::PlanFlag;
use crate::model::{Fields, Model};
use std::array::from_fn;
use std::ops::Range;
use wide::f64x4;

pub(super) const ROW: AlgorithmRow = AlgorithmRow {
    name: "planar",
    covers,
    copies: &chain::COPIES,
    load: |m, w| w.algorithms.planar_chain.load(m),
    forces: Some(Forces {
        mass,
        bias,
        bias_uses_poses: |_, _| false,
        constant: |_, _| false,
        bias_is_free_torque: false,
    }),
    factors: Some(Factors {
        without_mass: true,
        factor,
        complete: rows_of_factor,
        solve,
        solve_with,
        factor_and_solve,
        solve_both,
    }),
    ..NOTHING
};

/// Maximum number of degrees of freedom of chains for which closed-form equations are faster.
const MAX_CLOSED_FORM_DOFS: usize = 6;
/// Largest deviation, as a cosine, of an axis from the normal of the plane.
const FLAT: f64 = 1e-12;

/// The chains of this algorithm.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Trees {
    /// Spatial parameters of the links.
    chains: chain::Trees,
    spans: Vec<ChainSpan>,
    links: Vec<PlanarLink>,
    joints: Vec<[PlanarJoint; 2]>,
    hinges: Vec<FourHinges>,
    /// Whether all chains are currently planar.
    flat: bool,
    /// Whether no tendon has inertia. The inertia of tendons can couple links; chains are then solved with the rows
    /// of M.
    untied: bool,
}

/// A chain: its degrees of freedom, the range of its links in `links`, and the axes of its plane, world frame.
#[derive(Clone, Debug, Default, PartialEq)]
struct ChainSpan {
    dofs: Range<usize>,
    links: Range<usize>,
    plane: [Vec3; 2],
}

/// The anchors and the senses of four hinges in series, for loops along the rows of a matrix.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct FourHinges {
    anchor: [f64x4; 2],
    sense: f64x4,
}

fn load_hinges(hinges: &mut [FourHinges], links: &[PlanarLink]) {
    for (hinges, four) in hinges.iter_mut().zip(links.chunks(4)) {
        let gathered = |get: fn(&PlanarLink) -> f64| f64x4::new(from_fn(|i| four.get(i).map_or(0.0, get)));
        hinges.anchor = [gathered(|link| link.anchor[0]), gathered(|link| link.anchor[1])];
        hinges.sense = gathered(|link| link.sense);
    }
}

/// Writes a row of n elements at the start of `rows`, which ends with the last row of the chain: `get` gives the elements from their
/// hinges. The last group may also write elements of the next rows, so rows are written in ascending order.
#[cfg_attr(not(feature = "small"), inline(always))]
fn fill(rows: &mut [f64], n: usize, hinges: &[FourHinges], get: impl Fn(&FourHinges) -> f64x4) {
    let groups = n.div_ceil(4).min(hinges.len());
    let (fours, end) = rows.as_chunks_mut::<4>();
    for (to, hinges) in fours.iter_mut().zip(&hinges[..groups]) {
        *to = get(hinges).to_array();
    }
    // The rows end within a group of four.
    if let Some(hinges) = hinges[..groups].get(fours.len()) {
        end.iter_mut().zip(get(hinges).to_array()).for_each(|(to, element)| *to = element);
    }
}

/// Whether a tree was a long planar chain when the model was compiled.
fn covers(m: &Model, tree: usize) -> bool {
    m.planar_trees.binary_search(&(tree as i32)).is_ok()
}

/// Whether a tree is a long chain of hinges in series, starting at the world.
pub(super) fn is_chain(m: &Model, tree: usize) -> bool {
    let dofs = m.tree_dofs(tree);
    let first = dofs.start;
    let link = |k: usize| {
        (k == first || m.dof_parentid[k] == k as i32 - 1)
            && m.jnt_type[m.dof_jntid[k] as usize] == joint::HINGE
    };
    let on_the_world = |k: usize| m.body_weldid[m.body_parentid[m.dof_bodyid[k] as usize] as usize] == 0;
    dofs.len() > MAX_CLOSED_FORM_DOFS && dofs.clone().all(link) && on_the_world(first)
}

/// Whether a tree is a long chain of hinges that moves in a plane.
pub(super) fn is_planar(m: &Model, tree: usize) -> bool {
    if !is_chain(m, tree) {
        return false;
    }
    let assignment = Assignment { forces: vec![tree], ..Assignment::default() };
    Trees::new(m, &assignment).flat
}

impl Trees {
    pub(super) fn is_empty(&self) -> bool {
        self.links.is_empty()
    }

    pub(super) fn new(m: &Model, assignment: &Assignment) -> Trees {
        let chains = chain::Trees::new(m, assignment);
        let (mut links, mut spans) = (0, Vec::new());
        for &tree in &assignment.forces {
            let dofs = m.tree_dofs(tree);
            let n = dofs.len();
            spans.push(ChainSpan { dofs, links: links..links + n, plane: Default::default() });
            links += n;
        }
        let mut trees = Trees {
            chains,
            spans,
            links: vec![PlanarLink::default(); links],
            joints: vec![[PlanarJoint::default(); 2]; links],
            hinges: vec![FourHinges::default(); links.div_ceil(4)],
            flat: true,
            untied: true,
        };
        trees.load(m);
        trees
    }

    /// Reads the parameters of the links from the model.
    fn load(&mut self, m: &Model) {
        if self.links.is_empty() {
            return;
        }
        self.chains.load(m);
        self.flat = true;
        for span in &mut self.spans {
            let mut above = EYE;
            let mut normal = None;
            let mut plane = span.plane;
            let all = self.chains.parameters().skip(span.links.start);
            for (link, (fixed, coordinate)) in self.links[span.links.clone()].iter_mut().zip(all) {
                let turn = mat_mul(&above, &fixed.turn);
                let axis = mat_mul_vec(&turn, fixed.axis);
                let normal = *normal.get_or_insert_with(|| {
                    plane = chain::plane_of(axis);
                    axis
                });
                let along = dot(axis, normal);
                self.flat &= (along.abs() - 1.0).abs() < FLAT;
                let flat = |v: Vec3| [dot(plane[0], v), dot(plane[1], v)];
                let com = flat(mat_mul_vec(&turn, fixed.com));
                let across = mat_t_mul_vec(&turn, normal);
                *link = PlanarLink {
                    offset: flat(mat_mul_vec(&above, fixed.position)),
                    com,
                    sense: along.round(),
                    mass: fixed.mass,
                    inertia: fixed.moment(across) + fixed.mass * dot(com, com),
                    armature: fixed.armature,
                    reference: fixed.reference,
                    coordinate,
                    ..*link
                };
                above = turn;
            }
            span.plane = plane;
        }
    }
}

/// Computes the positions of the links, and the rows of M if they are read.
#[inline(never)] // so that scenes without such chains do not execute its setup code; the same applies below
fn mass(m: &Model, d: &mut Fields, w: &mut DynamicsScratch) {
    let rows = w.needs_mass_rows;
    let trees = &mut w.algorithms.planar_chain;
    if !trees.flat {
        return in_space(m, d, w);
    }
    for span in &trees.spans {
        let links = &mut trees.links[span.links.clone()];
        forward_kinematics(links, &d.qpos);
        if rows {
            load_hinges(&mut trees.hinges, links);
            rows_of_mass(m, &mut d.M, span, links, &trees.hinges);
        }
    }
}

/// Computes the rows of M of chains that are no longer planar.
fn in_space(m: &Model, d: &mut Fields, w: &mut DynamicsScratch) {
    kinematics::bodies(d, super::general::frames(w));
    com::com_pos(m, d);
    com::body_inertias(m, d);
    for span in w.algorithms.planar_chain.spans.iter().map(|span| span.dofs.clone()) {
        rows_of_m::composite_inertia(m, d, &mut w.path, &[span]);
    }
}

/// Computes the rows of M: the angular momentum about a hinge of all links beyond it, for a unit velocity of a hinge
/// before it.
fn rows_of_mass(
    m: &Model,
    mass: &mut [f64],
    span: &ChainSpan,
    links: &mut [PlanarLink],
    hinges: &[FourHinges],
) {
    let (mut moment, mut first, mut total) = (0.0, [0.0; 2], 0.0);
    for link in links.iter_mut().rev() {
        moment += link.inertia;
        first = add(first, [-link.mass * link.arm[1], link.mass * link.arm[0]]);
        total += link.mass;
        link.beyond = (moment, first);
        let q = link.quarter;
        moment += dot(q, add(scale(first, 2.0), scale(q, total)));
        first = add_scaled(first, q, total);
    }
    // Row i of a chain has i + 1 elements.
    let mut rows = &mut mass[rows_of_m::rows_of(m, span.dofs.clone())];
    for (i, link) in links.iter().enumerate() {
        let anchor = link.anchor.map(f64x4::splat);
        let moment = f64x4::splat(link.sense * link.beyond.0);
        let first = scale(link.beyond.1, link.sense).map(f64x4::splat);
        fill(rows, i + 1, hinges, |before| {
            let [x, y] = sub(anchor, before.anchor);
            before.sense * (first[1] * x - first[0] * y + moment)
        });
        let (row, below) = rows.split_at_mut(i + 1);
        row[i] += link.armature;
        rows = below;
    }
}

/// Computes the bias force.
#[inline(never)]
fn bias(m: &Model, d: &mut Fields, w: &mut DynamicsScratch, gravity: Vec3) {
    if !w.algorithms.planar_chain.flat {
        com::com_vel(m, d);
        return rne::newton_euler(m, d, w, gravity);
    }
    let Trees { spans, links, .. } = &mut w.algorithms.planar_chain;
    for span in spans.iter() {
        let links = &mut links[span.links.clone()];
        // Gravity is included as an upward acceleration of the world.
        let mut acceleration = span.plane.map(|axis| -dot(axis, gravity));
        let mut turning = 0.0;
        for (link, v) in links.iter_mut().zip(&d.qvel[span.dofs.clone()]) {
            // The vector from the previous anchor is r = (q_y, -q_x); the anchor rotates about the previous one.
            let centripetal = turning * turning;
            acceleration[0] -= centripetal * link.quarter[1];
            acceleration[1] += centripetal * link.quarter[0];
            turning += link.sense * v;
            let force = add_scaled(acceleration, link.arm, -(turning * turning));
            let [x, y] = scale(force, link.mass);
            link.force = [link.arm[0] * y - link.arm[1] * x, x, y];
        }
        let mut carried = [0.0; 3];
        for (link, out) in links.iter().zip(&mut d.qfrc_bias[span.dofs.clone()]).rev() {
            let [torque, x, y] = add(link.force, carried);
            *out = link.sense * torque;
            carried = [torque + link.quarter[0] * x + link.quarter[1] * y, x, y];
        }
    }
}

/// Computes U and 1/D for solving with M. With `x`, also x ← M⁻¹ x.
#[cfg_attr(not(feature = "small"), inline(always))]
fn prepare(m: &Model, d: &mut Fields, w: &mut DynamicsScratch, mut x: Option<&mut [f64]>) -> Option<usize> {
    let trees = &mut w.algorithms.planar_chain;
    trees.untied = m.ntendon == 0 || !reflected::tendons_have_inertia(m);
    let mut bad = None;
    for ChainSpan { dofs, links: range, .. } in &trees.spans {
        let (links, joints) = (&trees.links[range.clone()], &mut trees.joints[range.clone()]);
        let found = match (x.as_deref_mut(), trees.untied && trees.flat) {
            (Some(x), true) => {
                let x = &mut x[dofs.clone()];
                for ((joint, link), x) in joints.iter_mut().zip(links).zip(&*x) {
                    (joint[0].diagonal, joint[0].x) = (link.armature, *x);
                }
                let bad = inward::<0, 1, true>(links, joints);
                outward::<0, 1>(links, joints);
                x.iter_mut().zip(&*joints).for_each(|(x, joint)| *x = joint[0].x);
                bad
            }
            (None, true) => {
                joints.iter_mut().zip(links).for_each(|(joint, link)| joint[0].diagonal = link.armature);
                inward::<0, 1, false>(links, joints)
            }
            (x, false) => {
                let bad = rows_of_m::factor_copy(m, &d.M, &mut d.qLD, &mut d.qLDiagInv, dofs.clone());
                if let Some(x) = x {
                    rows_of_m::solve(m, &d.qLD, &d.qLDiagInv, x, dofs.clone());
                }
                bad.map(|k| k - dofs.start)
            }
        };
        bad = bad.or(found.map(|k| dofs.start + k));
    }
    bad
}

#[inline(never)]
fn factor(m: &Model, d: &mut Fields, w: &mut DynamicsScratch) -> Option<usize> {
    let bad = prepare(m, d, w, None);
    w.rows_due = d.plan.has(PlanFlag::MassForRows);
    if !w.rows_due {
        rows_of_factor(m, d, w);
    }
    bad
}

#[inline(never)]
fn factor_and_solve(m: &Model, d: &mut Fields, w: &mut DynamicsScratch, x: &mut [f64]) -> Option<usize> {
    prepare(m, d, w, Some(x))
}

#[inline(never)]
fn solve_both(m: &Model, d: &mut Fields, w: &mut DynamicsScratch, (b, x, y): Damped<'_>) -> Option<usize> {
    let trees = &mut w.algorithms.planar_chain;
    trees.untied = m.ntendon == 0 || !reflected::tendons_have_inertia(m);
    if !(trees.untied && trees.flat) {
        solve_with(m, d, w, b, y);
        return factor_and_solve(m, d, w, x);
    }
    let mut bad = None;
    for ChainSpan { dofs, links: range, .. } in &trees.spans {
        let (links, joints) = (&trees.links[range.clone()], &mut trees.joints[range.clone()]);
        let (b, x, y) = (&b[dofs.clone()], &mut x[dofs.clone()], &mut y[dofs.clone()]);
        for ((joint, link), ((b, x), y)) in joints.iter_mut().zip(links).zip(b.iter().zip(&*x).zip(&*y)) {
            (joint[0].diagonal, joint[0].x) = (link.armature, *x);
            (joint[1].diagonal, joint[1].x) = (link.armature + b, *y);
        }
        let found = inward::<0, 2, true>(links, joints);
        outward::<0, 2>(links, joints);
        for (joint, (x, y)) in joints.iter().zip(x.iter_mut().zip(y)) {
            (*x, *y) = (joint[0].x, joint[1].x);
        }
        bad = bad.or(found.map(|k| dofs.start + k));
    }
    bad
}

/// Computes the rows of `qLD`, and `qLDiagInv`.
#[inline(never)]
fn rows_of_factor(m: &Model, d: &mut Fields, w: &mut DynamicsScratch) {
    let Trees { spans, links, joints, hinges, untied, flat, .. } = &mut w.algorithms.planar_chain;
    if !(*untied && *flat) {
        return;
    }
    for span in spans.iter() {
        let (links, joints) = (&links[span.links.clone()], &joints[span.links.clone()]);
        load_hinges(hinges, links);
        let mut rows = &mut d.qLD[rows_of_m::rows_of(m, span.dofs.clone())];
        let inverses = &mut d.qLDiagInv[span.dofs.clone()];
        for (i, ((link, [joint, _]), inverse)) in links.iter().zip(joints).zip(inverses).enumerate() {
            let (anchor, u) = (link.anchor.map(f64x4::splat), scale(joint.u, joint.inv).map(f64x4::splat));
            fill(rows, i + 1, hinges, |before| {
                let [x, y] = sub(anchor, before.anchor);
                before.sense * (u[2] * x - u[1] * y + u[0])
            });
            let (row, below) = rows.split_at_mut(i + 1);
            (row[i], *inverse) = (1.0 / joint.inv, joint.inv);
            rows = below;
        }
    }
}

#[inline(never)]
fn solve(m: &Model, d: &Fields, w: &mut DynamicsScratch, x: &mut [f64]) {
    let Trees { spans, links, joints, untied, flat, .. } = &mut w.algorithms.planar_chain;
    for ChainSpan { dofs, links: range, .. } in spans.iter() {
        if !(*untied && *flat) {
            rows_of_m::solve(m, &d.qLD, &d.qLDiagInv, x, dofs.clone());
            continue;
        }
        let (x, joints) = (&mut x[dofs.clone()], &mut joints[range.clone()]);
        joints.iter_mut().zip(&*x).for_each(|(joint, x)| joint[0].x = *x);
        solve_known(&links[range.clone()], joints);
        x.iter_mut().zip(&*joints).for_each(|(x, joint)| *x = joint[0].x);
    }
}

#[inline(never)]
fn solve_with(m: &Model, d: &Fields, w: &mut DynamicsScratch, b: &[f64], x: &mut [f64]) {
    let Trees { spans, links, joints, untied, flat, .. } = &mut w.algorithms.planar_chain;
    for ChainSpan { dofs, links: range, .. } in spans.iter() {
        if !(*untied && *flat) {
            rows_of_m::solve_with(m, &d.M, b, [&mut w.ld, &mut w.diag_inv], dofs.clone(), x);
            continue;
        }
        let (links, joints) = (&links[range.clone()], &mut joints[range.clone()]);
        let (b, x) = (&b[dofs.clone()], &mut x[dofs.clone()]);
        for ((joint, link), (b, x)) in joints.iter_mut().zip(links).zip(b.iter().zip(&*x)) {
            (joint[1].diagonal, joint[1].x) = (link.armature + b, *x);
        }
        inward::<1, 2, true>(links, joints);
        outward::<1, 2>(links, joints);
        x.iter_mut().zip(&*joints).for_each(|(x, joint)| *x = joint[1].x);
    }
}
