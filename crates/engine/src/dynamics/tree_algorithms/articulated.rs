//! Articulated-body algorithm (Featherstone 2008, chapter 7) for trees with many degrees of freedom. It avoids the
//! cost of the rows of M.
//!
//! A force on a body accelerates the body with its subtree as if it were a single body with the articulated inertia
//!
//! > Iᴬ = I + Σ over children (Iᴬ - U Uᵀ / D),   U = Iᴬ s,   D = s·U + inertia of the joint
//!
//! with one term for each degree of freedom s of the child. One pass from the leaves to the root computes all U and
//! D. They are the factorization M = Lᵀ D L with L_kj = U_k·s_j / D_k for the ancestors j of k (Rodriguez 1987,
//! *Kalman filtering, smoothing, and recursive robot arm forward and inverse dynamics*). They give M⁻¹ f in one pass
//! up and one pass down the tree.
//!
//! All quantities are expressed about the centre of mass of the tree, like `cdof` and `cinert`, so no transformations
//! between bodies are needed.

use super::{AlgorithmRow, Assignment, Damped, Factors, NOTHING};
use crate::dynamics::{DynamicsScratch, mass, reflected};
use crate::math::*;
use crate::model::plan::PlanFlag;
use crate::model::{Fields, Model};
use std::ops::Range;

pub(super) const ROW: AlgorithmRow = AlgorithmRow {
    name: "articulated",
    covers,
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

/// Maximum number of degrees of freedom of trees for which elimination in the rows of M is faster.
const MAX_DENSE_DOFS: usize = 6;

/// Six numbers and two zeros, which fill two SIMD vectors of four lanes.
type PaddedSpatial = [f64; 8];

/// The trees of this algorithm, with scratch.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Trees {
    spans: Vec<TreeSpan>,
    /// Whether no tendon has inertia. The inertia of tendons can couple bodies of a tree; trees are then solved with
    /// the rows of M.
    untied: bool,
    links: Vec<ArticulatedLink>,
    /// One entry for each body, and one for each degree of freedom. Each has two parts: one for M, one for M with an
    /// addition to its diagonal.
    bodies: Vec<[ArticulatedBody; 2]>,
    joints: Vec<[ArticulatedJoint; 2]>,
}

/// A tree: its degrees of freedom and its bodies.
#[derive(Clone, Debug, Default, PartialEq)]
struct TreeSpan {
    dofs: Range<usize>,
    bodies: Range<usize>,
    /// Bodies without degrees of freedom, the last first: body and parent.
    fixed: Vec<(usize, usize)>,
}

/// The position of a degree of freedom in its tree.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct ArticulatedLink {
    /// The body that it moves.
    body: usize,
    /// The moving body that carries `body`, for the first degree of freedom of a body that is not the root.
    carrier: Option<usize>,
    first: bool,
}

/// Articulated inertia and force of a body with its children, and its acceleration.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct ArticulatedBody {
    inertia: [PaddedSpatial; 6],
    force: PaddedSpatial,
    acceleration: PaddedSpatial,
}

/// U and 1/D, the addition of the joint to the diagonal of the matrix, and an element of the vector that is solved
/// for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct ArticulatedJoint {
    u: PaddedSpatial,
    inv: f64,
    diagonal: f64,
    x: f64,
}

/// The inputs of the passes over a tree.
struct Passes<'a> {
    span: &'a TreeSpan,
    links: &'a [ArticulatedLink],
    cdof: &'a [Spatial],
}

/// Whether a tree has many degrees of freedom.
fn covers(m: &Model, tree: usize) -> bool {
    let mut dofs = m.tree_dofs(tree);
    dofs.len() > MAX_DENSE_DOFS && dofs.any(|k| m.dof_simplenum[k] == 0)
}

impl Trees {
    pub(super) fn new(m: &Model, assignment: &Assignment) -> Trees {
        let span = |&tree: &usize| {
            let dofs = m.tree_dofs(tree);
            // Bodies are numbered depth first, so those of a tree are consecutive.
            let root = m.dof_bodyid[dofs.start] as usize;
            let end = (root..m.nbody).find(|&b| m.body_treeid[b] != tree as i32).unwrap_or(m.nbody);
            let still = |&b: &usize| m.body_dofnum[b] == 0;
            let fixed = (root..end).rev().filter(still).map(|b| (b, m.body_parentid[b] as usize));
            TreeSpan { dofs, bodies: root..end, fixed: fixed.collect() }
        };
        let (bodies, joints) = if assignment.factors.is_empty() { (0, 0) } else { (m.nbody, m.nv) };
        let link = |k: usize| {
            let body = m.dof_bodyid[k] as usize;
            let first = m.body_dofadr[body] == k as i32;
            let carrier = usize::try_from(m.dof_parentid[k]).ok().map(|up| m.dof_bodyid[up] as usize);
            ArticulatedLink { body, carrier: carrier.filter(|_| first), first }
        };
        Trees {
            spans: assignment.factors.iter().map(span).collect(),
            untied: true,
            links: (0..joints).map(link).collect(),
            bodies: vec![[ArticulatedBody::default(); 2]; bodies],
            joints: vec![[ArticulatedJoint::default(); 2]; joints],
        }
    }
}

/// Each pass processes the matrices `A..B` at the same time, because their sums are independent of each other.
impl Passes<'_> {
    /// Computes U and D of every degree of freedom. Returns the first one whose D is not positive. With `X`, it also
    /// performs the inward pass of [`Passes::solve`].
    #[inline(never)]
    fn factor<const A: usize, const B: usize, const X: bool>(
        &self,
        cinert: &[Inertia],
        bodies: &mut [[ArticulatedBody; 2]],
        joints: &mut [[ArticulatedJoint; 2]],
    ) -> Option<usize> {
        let range = self.span.bodies.clone();
        for (body, inertia) in bodies[range.clone()].iter_mut().zip(&cinert[range]) {
            for body in &mut body[A..B] {
                set_inertia(&mut body.inertia, inertia);
                body.force = [0.0; 8];
            }
        }
        for &(body, carrier) in &self.span.fixed {
            let Some((here, up)) = with_carrier(bodies, body, carrier) else { continue };
            for i in A..B {
                add_to(&mut up[i].inertia, &here[i].inertia);
            }
        }
        let mut bad = None;
        let dofs = self.span.dofs.clone();
        let links = self.links[dofs.clone()].iter().zip(&self.cdof[dofs.clone()]);
        for ((k, joint), (link, s)) in dofs.clone().zip(&mut joints[dofs]).zip(links).rev() {
            for i in A..B {
                if eliminate(&mut bodies[link.body][i].inertia, s, &mut joint[i]) {
                    bad = Some(k);
                }
            }
            if X {
                inward_pass::<A, B>(bodies, link, s, joint);
            }
            let Some((here, up)) = link.carrier.and_then(|c| with_carrier(bodies, link.body, c)) else {
                continue;
            };
            for i in A..B {
                add_to(&mut up[i].inertia, &here[i].inertia);
            }
        }
        bad
    }

    /// x ← M⁻¹ x.
    #[cfg_attr(not(feature = "small"), inline(always))]
    fn solve<const A: usize, const B: usize>(
        &self,
        bodies: &mut [[ArticulatedBody; 2]],
        joints: &mut [[ArticulatedJoint; 2]],
    ) {
        for body in &mut bodies[self.span.bodies.clone()] {
            for body in &mut body[A..B] {
                body.force = [0.0; 8];
            }
        }
        let dofs = self.span.dofs.clone();
        let links = self.links[dofs.clone()].iter().zip(&self.cdof[dofs.clone()]);
        for (joint, (link, s)) in joints[dofs].iter_mut().zip(links).rev() {
            inward_pass::<A, B>(bodies, link, s, joint);
        }
        self.outward_pass::<A, B>(bodies, joints);
    }

    /// The outward pass, from the root to the leaves.
    #[inline(never)]
    fn outward_pass<const A: usize, const B: usize>(
        &self,
        bodies: &mut [[ArticulatedBody; 2]],
        joints: &mut [[ArticulatedJoint; 2]],
    ) {
        let dofs = self.span.dofs.clone();
        let links = self.links[dofs.clone()].iter().zip(&self.cdof[dofs.clone()]);
        for (joint, (link, s)) in joints[dofs].iter_mut().zip(links) {
            // Bodies before this one have been processed.
            let before = match link.carrier {
                Some(carrier) => bodies[carrier].map(|body| body.acceleration),
                None if link.first => [[0.0; 8]; 2],
                None => bodies[link.body].map(|body| body.acceleration),
            };
            let here = &mut bodies[link.body];
            for i in A..B {
                joint[i].x -= joint[i].inv * dot(joint[i].u, before[i]);
                here[i].acceleration = add_scaled(before[i], pad(s), joint[i].x);
            }
        }
    }
}

/// One degree of freedom of the inward pass: subtracts the force that its joint takes up, and passes on the rest.
#[cfg_attr(not(feature = "small"), inline(always))]
fn inward_pass<const A: usize, const B: usize>(
    bodies: &mut [[ArticulatedBody; 2]],
    link: &ArticulatedLink,
    s: &Spatial,
    joint: &mut [ArticulatedJoint; 2],
) {
    let here = &mut bodies[link.body];
    let mut forces = [[0.0; 8]; 2];
    for i in A..B {
        joint[i].x = (joint[i].x - dot(pad(s), here[i].force)) * joint[i].inv;
        forces[i] = add_scaled(here[i].force, joint[i].u, joint[i].x);
    }
    match link.carrier {
        Some(carrier) => {
            let up = &mut bodies[carrier];
            (A..B).for_each(|i| up[i].force = add(up[i].force, forces[i]));
        }
        None => (A..B).for_each(|i| here[i].force = forces[i]),
    }
}

/// A body, and the parent body that carries it, which precedes it.
#[cfg_attr(not(feature = "small"), inline(always))]
fn with_carrier(
    bodies: &mut [[ArticulatedBody; 2]],
    body: usize,
    carrier: usize,
) -> Option<(&[ArticulatedBody; 2], &mut [ArticulatedBody; 2])> {
    let (above, rest) = bodies.split_at_mut(body);
    Some((rest.first()?, above.get_mut(carrier)?))
}

#[inline(never)] // so that scenes with small trees do not execute its setup code; the same applies below
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

/// Computes U and 1/D for solving with M. With `x`, also x ← M⁻¹ x.
#[cfg_attr(not(feature = "small"), inline(always))]
fn prepare(m: &Model, d: &mut Fields, w: &mut DynamicsScratch, mut x: Option<&mut [f64]>) -> Option<usize> {
    let articulated = &mut w.algorithms.articulated;
    articulated.untied = m.ntendon == 0 || !reflected::tendons_have_inertia(m);
    let Trees { spans, untied, links, bodies, joints } = articulated;
    let mut bad = None;
    for span in spans.iter() {
        let dofs = span.dofs.clone();
        let x = x.as_deref_mut();
        let found = if *untied {
            for k in dofs.clone() {
                joints[k][0].diagonal = mass::armature(m, k);
            }
            let tree = Passes { span, links, cdof: rows(&d.cdof) };
            match x {
                Some(x) => {
                    put::<0>(joints, dofs.clone(), x);
                    let bad = tree.factor::<0, 1, true>(rows(&d.cinert), bodies, joints);
                    tree.outward_pass::<0, 1>(bodies, joints);
                    get::<0>(joints, dofs, x);
                    bad
                }
                None => tree.factor::<0, 1, false>(rows(&d.cinert), bodies, joints),
            }
        } else {
            let bad = mass::factor_copy(m, &d.M, &mut d.qLD, &mut d.qLDiagInv, dofs.clone());
            if let Some(x) = x {
                mass::solve(m, &d.qLD, &d.qLDiagInv, x, dofs);
            }
            bad
        };
        bad = bad.or(found);
    }
    bad
}

#[inline(never)]
fn solve_both(m: &Model, d: &mut Fields, w: &mut DynamicsScratch, (b, x, y): Damped<'_>) -> Option<usize> {
    let articulated = &mut w.algorithms.articulated;
    articulated.untied = m.ntendon == 0 || !reflected::tendons_have_inertia(m);
    let Trees { spans, untied, links, bodies, joints } = articulated;
    let mut bad = None;
    for span in spans.iter() {
        let dofs = span.dofs.clone();
        let found = if *untied {
            let numbers = joints[dofs.clone()].iter_mut().zip(&b[dofs.clone()]);
            for ((k, (joint, b)), (x, y)) in
                dofs.clone().zip(numbers).zip(x[dofs.clone()].iter().zip(&y[dofs.clone()]))
            {
                let armature = mass::armature(m, k);
                (joint[0].diagonal, joint[0].x) = (armature, *x);
                (joint[1].diagonal, joint[1].x) = (armature + b, *y);
            }
            let tree = Passes { span, links, cdof: rows(&d.cdof) };
            let bad = tree.factor::<0, 2, true>(rows(&d.cinert), bodies, joints);
            tree.outward_pass::<0, 2>(bodies, joints);
            get::<0>(joints, dofs.clone(), x);
            get::<1>(joints, dofs, y);
            bad
        } else {
            mass::solve_with(m, &d.M, b, [&mut w.ld, &mut w.diag_inv], dofs.clone(), y);
            let bad = mass::factor_copy(m, &d.M, &mut d.qLD, &mut d.qLDiagInv, dofs.clone());
            mass::solve(m, &d.qLD, &d.qLDiagInv, x, dofs);
            bad
        };
        bad = bad.or(found);
    }
    bad
}

/// Copies a vector to the joints, for matrix `I`.
#[cfg_attr(not(feature = "small"), inline(always))]
fn put<const I: usize>(joints: &mut [[ArticulatedJoint; 2]], dofs: Range<usize>, x: &[f64]) {
    for (joint, x) in joints[dofs.clone()].iter_mut().zip(&x[dofs]) {
        joint[I].x = *x;
    }
}

/// Copies the vector of matrix `I` from the joints.
#[cfg_attr(not(feature = "small"), inline(always))]
fn get<const I: usize>(joints: &[[ArticulatedJoint; 2]], dofs: Range<usize>, x: &mut [f64]) {
    for (x, joint) in x[dofs.clone()].iter_mut().zip(&joints[dofs]) {
        *x = joint[I].x;
    }
}

/// Computes the rows of `qLD`, and `qLDiagInv`.
#[inline(never)]
fn rows_of_factor(m: &Model, d: &mut Fields, w: &mut DynamicsScratch) {
    let Trees { spans, untied, joints, .. } = &w.algorithms.articulated;
    if !*untied {
        return;
    }
    let cdof = rows::<6>(&d.cdof);
    for k in spans.iter().flat_map(|span| span.dofs.clone()) {
        let ArticulatedJoint { u, inv, .. } = &joints[k][0];
        d.qLDiagInv[k] = *inv;
        let row = &mut d.qLD[mass::row(m, k)];
        let depth = row.len() - 1;
        w.path.extend(depth, &cdof[k]);
        w.path.product(&unpad(&scale(*u, *inv)), row);
        row[depth] = 1.0 / inv;
    }
}

#[inline(never)]
fn solve(m: &Model, d: &Fields, w: &mut DynamicsScratch, x: &mut [f64]) {
    let Trees { spans, untied, links, bodies, joints } = &mut w.algorithms.articulated;
    for span in spans.iter() {
        if *untied {
            put::<0>(joints, span.dofs.clone(), x);
            Passes { span, links, cdof: rows(&d.cdof) }.solve::<0, 1>(bodies, joints);
            get::<0>(joints, span.dofs.clone(), x);
        } else {
            mass::solve(m, &d.qLD, &d.qLDiagInv, x, span.dofs.clone());
        }
    }
}

#[inline(never)]
fn solve_with(m: &Model, d: &Fields, w: &mut DynamicsScratch, b: &[f64], x: &mut [f64]) {
    let Trees { spans, untied, links, bodies, joints } = &mut w.algorithms.articulated;
    for span in spans.iter() {
        let dofs = span.dofs.clone();
        if *untied {
            for (joint, (b, x)) in
                joints[dofs.clone()].iter_mut().zip(b[dofs.clone()].iter().zip(&x[dofs.clone()]))
            {
                (joint[1].diagonal, joint[1].x) = (joint[0].diagonal + b, *x);
            }
            let tree = Passes { span, links, cdof: rows(&d.cdof) };
            tree.factor::<1, 2, true>(rows(&d.cinert), bodies, joints);
            tree.outward_pass::<1, 2>(bodies, joints);
            get::<1>(joints, dofs, x);
        } else {
            mass::solve_with(m, &d.M, b, [&mut w.ld, &mut w.diag_inv], dofs, x);
        }
    }
}

#[cfg_attr(not(feature = "small"), inline(always))]
fn pad(s: &Spatial) -> PaddedSpatial {
    [s[0], s[1], s[2], s[3], s[4], s[5], 0.0, 0.0]
}

#[cfg_attr(not(feature = "small"), inline(always))]
fn unpad(w: &PaddedSpatial) -> Spatial {
    [w[0], w[1], w[2], w[3], w[4], w[5]]
}

/// a · b, with partial sums in four lanes.
#[cfg_attr(not(feature = "small"), inline(always))]
fn dot(a: PaddedSpatial, b: PaddedSpatial) -> f64 {
    let s: [f64; 4] = std::array::from_fn(|i| a[i] * b[i] + a[i + 4] * b[i + 4]);
    (s[0] + s[2]) + (s[1] + s[3])
}

/// Writes an inertia as a symmetric matrix by columns; the last two rows remain zero.
#[inline(never)] // see `eliminate`
fn set_inertia(to: &mut [PaddedSpatial; 6], i: &Inertia) {
    let [xx, yy, zz, xy, xz, yz, x, y, z, m] = *i;
    let columns = [
        [xx, xy, xz, 0.0, -z, y],
        [xy, yy, yz, z, 0.0, -x],
        [xz, yz, zz, -y, x, 0.0],
        [0.0, z, -y, m, 0.0, 0.0],
        [-z, 0.0, x, 0.0, m, 0.0],
        [y, -x, 0.0, 0.0, 0.0, m],
    ];
    for c in 0..6 {
        for r in 0..6 {
            to[c][r] = columns[c][r];
        }
    }
}

/// a ← a + b
#[inline(never)] // see `eliminate`
fn add_to(a: &mut [PaddedSpatial; 6], b: &[PaddedSpatial; 6]) {
    for c in 0..6 {
        a[c] = add(a[c], b[c]);
    }
}

/// Computes U and D of the degree of freedom s of a joint, and I ← I - U Uᵀ / D. Returns whether D is not positive.
#[inline(never)] // inlined into a loop, it would not be vectorized by lanes
fn eliminate(i: &mut [PaddedSpatial; 6], s: &Spatial, joint: &mut ArticulatedJoint) -> bool {
    // Three short independent sums, because the next degree of freedom waits for U.
    let part = |c: usize| add_scaled(scale(i[c], s[c]), i[c + 1], s[c + 1]);
    let u = add(add(part(0), part(2)), part(4));
    let d = joint.diagonal + dot(pad(s), u);
    let inv = 1.0 / d.max(MINVAL);
    let v = scale(u, -inv);
    for c in 0..6 {
        i[c] = add_scaled(i[c], u, v[c]);
    }
    (joint.u, joint.inv) = (u, inv);
    d < MINVAL
}

#[cfg(test)]
mod tests;
