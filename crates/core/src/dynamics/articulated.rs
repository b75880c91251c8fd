//! Articulated bodies (Featherstone 2008, chapter 7): trees of many degrees of freedom without the cost of rows of M.
//!
//! The subtree of a body answers a force on that body as one body would, whose inertia is
//!
//! > Iᴬ = I + Σ over children (Iᴬ - U Uᵀ / D),   U = Iᴬ s,   D = s·U + inertia of the joint
//!
//! with a term for each degree of freedom s of the child. One pass from the leaves to the root finds all U and D. They
//! are the factorization M = Lᵀ D L, whose rows are L_kj = U_k·s_j / D_k for the ancestors j of k (Rodriguez 1987,
//! *Kalman filtering, smoothing, and recursive robot arm forward and inverse dynamics*), and they give M⁻¹ f in a pass
//! up and a pass down the tree.
//!
//! Everything is expressed about the centre of mass of the tree, as `cdof` and `cinert` are: nothing is transformed
//! from body to body.

use crate::dynamics::{Scratch, mass, reflected, serial};
use crate::math::*;
use crate::model::way::Way;
use crate::model::way::Ways;
use crate::model::{Fields, Model};
use std::ops::Range;

/// Degrees of freedom of a tree up to which its rows of M are short enough to be eliminated one from the other.
const FEW: usize = 6;

/// Six numbers and two zeros: two vectors of a processor.
type Wide = [f64; 8];

/// The trees of a model by how they are solved, and scratch.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Articulated {
    /// Small ones; all others are in `spans`.
    serial: Vec<serial::Tree>,
    spans: Vec<Span>,
    /// Whether no tendon's inertia ties bodies of a tree together.
    untied: bool,
    links: Vec<Link>,
    /// One for each body, and one for each degree of freedom: first of M, then of M with something added to its
    /// diagonal.
    bodies: Vec<[Body; 2]>,
    joints: Vec<[Joint; 2]>,
}

/// A tree, or any number of trees that are solved by their rows of M.
#[derive(Clone, Debug, Default, PartialEq)]
struct Span {
    dofs: Range<usize>,
    /// The bodies of a tree of many degrees of freedom, none otherwise.
    bodies: Range<usize>,
    /// Those that cannot move on the body that carries them, the last first: body and carrier.
    fixed: Vec<(usize, usize)>,
}

impl Span {
    /// Whether it is solved by its bodies. Those that a tendon's inertia ties together are solved by their rows.
    #[cfg_attr(not(feature = "small"), inline(always))]
    fn by_bodies(&self, untied: bool) -> bool {
        untied && !self.bodies.is_empty()
    }
}

/// Where a degree of freedom is in its tree.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Link {
    /// The body that it moves.
    body: usize,
    /// The moving body that carries that one, for the first degree of freedom of a body that is not the root.
    carrier: Option<usize>,
    first: bool,
}

/// The inertia and the force that children have left to a body, and its acceleration.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Body {
    inertia: [Wide; 6],
    force: Wide,
    acceleration: Wide,
}

/// U and 1/D, what the joint adds to the diagonal of the matrix, and an element of the vector that is solved for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Joint {
    u: Wide,
    inv: f64,
    diagonal: f64,
    x: f64,
}

/// What the passes over a tree read.
struct Tree<'a> {
    span: &'a Span,
    links: &'a [Link],
    cdof: &'a [Spatial],
}

/// Whether a degree of freedom belongs to a tree of many, which is factorized as articulated bodies.
pub(crate) fn covers(m: &Model, dof: usize) -> bool {
    let tree = m.dof_treeid[dof] as usize;
    let first = m.tree_dofadr[tree] as usize;
    is_large(m, first..first + m.tree_dofnum[tree] as usize)
}

fn is_large(m: &Model, mut dofs: Range<usize>) -> bool {
    dofs.len() > FEW && dofs.any(|k| m.dof_simplenum[k] == 0)
}

impl Articulated {
    /// The trees of a model.
    pub(crate) fn new(m: &Model, ways: Ways) -> Articulated {
        let (mut serial, mut spans) = (Vec::new(), Vec::<Span>::new());
        for t in 0..m.ntree {
            let first = m.tree_dofadr[t] as usize;
            let dofs = first..first + m.tree_dofnum[t] as usize;
            if ways.has(Way::Articulated) && is_large(m, dofs.clone()) {
                // Bodies are numbered depth first: those of a tree follow each other.
                let root = m.dof_bodyid[first] as usize;
                let end = (root..m.nbody).find(|&b| m.body_treeid[b] != t as i32).unwrap_or(m.nbody);
                let still = |&b: &usize| m.body_dofnum[b] == 0;
                let fixed = (root..end).rev().filter(still).map(|b| (b, m.body_parentid[b] as usize));
                spans.push(Span { dofs, bodies: root..end, fixed: fixed.collect() });
                continue;
            }
            if let Some(tree) = serial::Tree::new(m, dofs.clone()).filter(|_| ways.has(Way::Serial)) {
                serial.push(tree);
                continue;
            }
            match spans.last_mut() {
                Some(last) if last.bodies.is_empty() && last.dofs.end == dofs.start => {
                    last.dofs.end = dofs.end
                }
                _ => spans.push(Span { dofs, ..Span::default() }),
            }
        }
        let any = spans.iter().any(|s| !s.bodies.is_empty());
        let (bodies, joints) = if any { (m.nbody, m.nv) } else { (0, 0) };
        let link = |k: usize| {
            let body = m.dof_bodyid[k] as usize;
            let first = m.body_dofadr[body] == k as i32;
            let carrier = usize::try_from(m.dof_parentid[k]).ok().map(|up| m.dof_bodyid[up] as usize);
            Link { body, carrier: carrier.filter(|_| first), first }
        };
        Articulated {
            serial,
            spans,
            untied: true,
            links: (0..joints).map(link).collect(),
            bodies: vec![[Body::default(); 2]; bodies],
            joints: vec![[Joint::default(); 2]; joints],
        }
    }
}

/// The passes go over matrices `A..B` at the same time: the sums of each do not wait for those of the other.
impl Tree<'_> {
    /// U and D of every degree of freedom. Returns the first one whose D is not positive. With `X`, the way up the tree of
    /// [`Tree::solve`] is gone as well.
    #[inline(never)]
    fn factor<const A: usize, const B: usize, const X: bool>(
        &self,
        cinert: &[Inertia],
        bodies: &mut [[Body; 2]],
        joints: &mut [[Joint; 2]],
    ) -> Option<usize> {
        let range = self.span.bodies.clone();
        for (body, inertia) in bodies[range.clone()].iter_mut().zip(&cinert[range]) {
            for body in &mut body[A..B] {
                set_inertia(&mut body.inertia, inertia);
                body.force = [0.0; 8];
            }
        }
        for &(body, carrier) in &self.span.fixed {
            let Some((own, up)) = with_carrier(bodies, body, carrier) else { continue };
            for i in A..B {
                add_to(&mut up[i].inertia, &own[i].inertia);
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
                rise::<A, B>(bodies, link, s, joint);
            }
            let Some((own, up)) = link.carrier.and_then(|c| with_carrier(bodies, link.body, c)) else {
                continue;
            };
            for i in A..B {
                add_to(&mut up[i].inertia, &own[i].inertia);
            }
        }
        bad
    }

    /// x ← M⁻¹ x.
    #[cfg_attr(not(feature = "small"), inline(always))]
    fn solve<const A: usize, const B: usize>(&self, bodies: &mut [[Body; 2]], joints: &mut [[Joint; 2]]) {
        for body in &mut bodies[self.span.bodies.clone()] {
            for body in &mut body[A..B] {
                body.force = [0.0; 8];
            }
        }
        let dofs = self.span.dofs.clone();
        let links = self.links[dofs.clone()].iter().zip(&self.cdof[dofs.clone()]);
        for (joint, (link, s)) in joints[dofs].iter_mut().zip(links).rev() {
            rise::<A, B>(bodies, link, s, joint);
        }
        self.fall::<A, B>(bodies, joints);
    }

    /// The way down, from the root to the leaves.
    #[inline(never)]
    fn fall<const A: usize, const B: usize>(&self, bodies: &mut [[Body; 2]], joints: &mut [[Joint; 2]]) {
        let dofs = self.span.dofs.clone();
        let links = self.links[dofs.clone()].iter().zip(&self.cdof[dofs.clone()]);
        for (joint, (link, s)) in joints[dofs].iter_mut().zip(links) {
            // The bodies before this one are done.
            let before = match link.carrier {
                Some(carrier) => bodies[carrier].map(|body| body.acceleration),
                None if link.first => [[0.0; 8]; 2],
                None => bodies[link.body].map(|body| body.acceleration),
            };
            let own = &mut bodies[link.body];
            for i in A..B {
                joint[i].x -= joint[i].inv * dot(joint[i].u, before[i]);
                own[i].acceleration = add_scaled(before[i], wide(s), joint[i].x);
            }
        }
    }
}

/// One degree of freedom on the way up: what its joint takes of the force on its body, and what it passes on.
#[cfg_attr(not(feature = "small"), inline(always))]
fn rise<const A: usize, const B: usize>(
    bodies: &mut [[Body; 2]],
    link: &Link,
    s: &Spatial,
    joint: &mut [Joint; 2],
) {
    let own = &mut bodies[link.body];
    let mut forces = [[0.0; 8]; 2];
    for i in A..B {
        joint[i].x = (joint[i].x - dot(wide(s), own[i].force)) * joint[i].inv;
        forces[i] = add_scaled(own[i].force, joint[i].u, joint[i].x);
    }
    match link.carrier {
        Some(carrier) => {
            let up = &mut bodies[carrier];
            (A..B).for_each(|i| up[i].force = add(up[i].force, forces[i]));
        }
        None => (A..B).for_each(|i| own[i].force = forces[i]),
    }
}

/// A body, and the one that carries it and comes before it.
#[cfg_attr(not(feature = "small"), inline(always))]
fn with_carrier(
    bodies: &mut [[Body; 2]],
    body: usize,
    carrier: usize,
) -> Option<(&[Body; 2], &mut [Body; 2])> {
    let (above, rest) = bodies.split_at_mut(body);
    Some((rest.first()?, above.get_mut(carrier)?))
}

/// `qLD` and `qLDiagInv`, the factorization of M. Returns the first degree of freedom whose D is not positive.
pub(crate) fn factor(m: &Model, d: &mut Fields, w: &mut Scratch) -> Option<usize> {
    let bad = prepare(m, d, w, None);
    rows_of_factor(m, d, w);
    bad
}

/// What solves with M, of large trees without `qLD`; and with `x`, x ← M⁻¹ x.
pub(crate) fn prepare(
    m: &Model,
    d: &mut Fields,
    w: &mut Scratch,
    mut x: Option<&mut [f64]>,
) -> Option<usize> {
    let mut bad = None;
    for tree in &w.articulated.serial {
        bad = bad.or(tree.factor(&d.M, &mut d.qLD, &mut d.qLDiagInv, x.as_deref_mut()));
    }
    if w.articulated.spans.is_empty() { bad } else { bad.or(prepare_spans(m, d, w, x)) }
}

#[inline(never)] // scenes of small trees do not carry the set-up of the others: so below
fn prepare_spans(m: &Model, d: &mut Fields, w: &mut Scratch, mut x: Option<&mut [f64]>) -> Option<usize> {
    let articulated = &mut w.articulated;
    articulated.untied = m.ntendon == 0 || !reflected::tendons_have_inertia(m);
    let Articulated { spans, untied, links, bodies, joints, .. } = articulated;
    let mut bad = None;
    for span in spans.iter() {
        let dofs = span.dofs.clone();
        let x = x.as_deref_mut();
        let found = if span.by_bodies(*untied) {
            for k in dofs.clone() {
                joints[k][0].diagonal = mass::armature(m, k);
            }
            let tree = Tree { span, links, cdof: rows(&d.cdof) };
            match x {
                Some(x) => {
                    put::<0>(joints, dofs.clone(), x);
                    let bad = tree.factor::<0, 1, true>(rows(&d.cinert), bodies, joints);
                    tree.fall::<0, 1>(bodies, joints);
                    get::<0>(joints, dofs, x);
                    bad
                }
                None => tree.factor::<0, 1, false>(rows(&d.cinert), bodies, joints),
            }
        } else {
            factor_rows(m, &d.M, &mut d.qLD, &mut d.qLDiagInv, dofs, x)
        };
        bad = bad.or(found);
    }
    bad
}

/// x ← M⁻¹ x and y ← (M + B)⁻¹ y for a diagonal matrix B (nv), and what solves with M: [`prepare`] and [`solve_with`] in
/// less time than one after the other.
pub(crate) fn prepare_both(
    m: &Model,
    d: &mut Fields,
    w: &mut Scratch,
    b: &[f64],
    x: &mut [f64],
    y: &mut [f64],
) -> Option<usize> {
    let mut bad = None;
    for tree in &w.articulated.serial {
        bad = bad.or(tree.factor(&d.M, &mut d.qLD, &mut d.qLDiagInv, Some(&mut *x)));
        tree.solve_with(&d.M, b, y);
    }
    if w.articulated.spans.is_empty() { bad } else { bad.or(prepare_both_spans(m, d, w, b, x, y)) }
}

#[inline(never)]
fn prepare_both_spans(
    m: &Model,
    d: &mut Fields,
    w: &mut Scratch,
    b: &[f64],
    x: &mut [f64],
    y: &mut [f64],
) -> Option<usize> {
    let articulated = &mut w.articulated;
    articulated.untied = m.ntendon == 0 || !reflected::tendons_have_inertia(m);
    let Articulated { spans, untied, links, bodies, joints, .. } = articulated;
    let mut bad = None;
    for span in spans.iter() {
        let dofs = span.dofs.clone();
        let found = if span.by_bodies(*untied) {
            let numbers = joints[dofs.clone()].iter_mut().zip(&b[dofs.clone()]);
            for ((k, (joint, b)), (x, y)) in
                dofs.clone().zip(numbers).zip(x[dofs.clone()].iter().zip(&y[dofs.clone()]))
            {
                let own = mass::armature(m, k);
                (joint[0].diagonal, joint[0].x) = (own, *x);
                (joint[1].diagonal, joint[1].x) = (own + b, *y);
            }
            let tree = Tree { span, links, cdof: rows(&d.cdof) };
            let bad = tree.factor::<0, 2, true>(rows(&d.cinert), bodies, joints);
            tree.fall::<0, 2>(bodies, joints);
            get::<0>(joints, dofs.clone(), x);
            get::<1>(joints, dofs, y);
            bad
        } else {
            solve_rows_with(m, &d.M, b, [&mut w.ld, &mut w.diag_inv], dofs.clone(), y);
            factor_rows(m, &d.M, &mut d.qLD, &mut d.qLDiagInv, dofs, Some(&mut *x))
        };
        bad = bad.or(found);
    }
    bad
}

/// A vector into the joints of matrix `I`.
#[cfg_attr(not(feature = "small"), inline(always))]
fn put<const I: usize>(joints: &mut [[Joint; 2]], dofs: Range<usize>, x: &[f64]) {
    for (joint, x) in joints[dofs.clone()].iter_mut().zip(&x[dofs]) {
        joint[I].x = *x;
    }
}

/// A vector from the joints of matrix `I`.
#[cfg_attr(not(feature = "small"), inline(always))]
fn get<const I: usize>(joints: &[[Joint; 2]], dofs: Range<usize>, x: &mut [f64]) {
    for (x, joint) in x[dofs.clone()].iter_mut().zip(&joints[dofs]) {
        *x = joint[I].x;
    }
}

/// `qLD` and `qLDiagInv` by rows of M; and with `x`, x ← M⁻¹ x.
fn factor_rows(
    m: &Model,
    mass: &[f64],
    ld: &mut [f64],
    diag_inv: &mut [f64],
    dofs: Range<usize>,
    x: Option<&mut [f64]>,
) -> Option<usize> {
    let entries = mass::rows_of(m, dofs.clone());
    ld[entries.clone()].copy_from_slice(&mass[entries]);
    let bad = mass::factor(m, ld, diag_inv, dofs.clone());
    if let Some(x) = x {
        mass::solve(m, ld, diag_inv, x, dofs);
    }
    bad
}

/// x ← (M + B)⁻¹ x by rows of M, with scratch for a factorization.
fn solve_rows_with(
    m: &Model,
    mass: &[f64],
    b: &[f64],
    [ld, diag_inv]: [&mut Vec<f64>; 2],
    dofs: Range<usize>,
    x: &mut [f64],
) {
    let entries = mass::rows_of(m, dofs.clone());
    ld[entries.clone()].copy_from_slice(&mass[entries]);
    for k in dofs.clone() {
        ld[mass::diagonal(m, k)] += b[k];
    }
    mass::factor(m, ld, diag_inv, dofs.clone());
    mass::solve(m, ld, diag_inv, x, dofs);
}

/// The rows of `qLD` that belong to articulated trees, and their `qLDiagInv`.
pub(crate) fn rows_of_factor(m: &Model, d: &mut Fields, w: &mut Scratch) {
    let Articulated { spans, untied, joints, .. } = &w.articulated;
    let cdof = rows::<6>(&d.cdof);
    for span in spans.iter().filter(|span| span.by_bodies(*untied)) {
        for k in span.dofs.clone() {
            let Joint { u, inv, .. } = &joints[k][0];
            d.qLDiagInv[k] = *inv;
            let row = &mut d.qLD[mass::row(m, k)];
            let depth = row.len() - 1;
            w.path.extend(depth, &cdof[k]);
            w.path.product(&narrow(&scale(*u, *inv)), row);
            row[depth] = 1.0 / inv;
        }
    }
}

/// x ← M⁻¹ x by what [`factor`] has left.
pub(crate) fn solve(m: &Model, d: &Fields, w: &mut Scratch, x: &mut [f64]) {
    for tree in &w.articulated.serial {
        tree.solve(d, x);
    }
    if !w.articulated.spans.is_empty() {
        solve_spans(m, d, w, x);
    }
}

#[inline(never)]
fn solve_spans(m: &Model, d: &Fields, w: &mut Scratch, x: &mut [f64]) {
    let Articulated { spans, untied, links, bodies, joints, .. } = &mut w.articulated;
    for span in spans.iter() {
        if span.by_bodies(*untied) {
            put::<0>(joints, span.dofs.clone(), x);
            Tree { span, links, cdof: rows(&d.cdof) }.solve::<0, 1>(bodies, joints);
            get::<0>(joints, span.dofs.clone(), x);
        } else {
            mass::solve(m, &d.qLD, &d.qLDiagInv, x, span.dofs.clone());
        }
    }
}

/// x ← (M + B)⁻¹ x for a diagonal matrix B (nv), after [`factor`].
pub(crate) fn solve_with(m: &Model, d: &Fields, w: &mut Scratch, b: &[f64], x: &mut [f64]) {
    for tree in &w.articulated.serial {
        tree.solve_with(&d.M, b, x);
    }
    if !w.articulated.spans.is_empty() {
        solve_spans_with(m, d, w, b, x);
    }
}

#[inline(never)]
fn solve_spans_with(m: &Model, d: &Fields, w: &mut Scratch, b: &[f64], x: &mut [f64]) {
    let Articulated { spans, untied, links, bodies, joints, .. } = &mut w.articulated;
    for span in spans.iter() {
        let dofs = span.dofs.clone();
        if span.by_bodies(*untied) {
            for (joint, (b, x)) in
                joints[dofs.clone()].iter_mut().zip(b[dofs.clone()].iter().zip(&x[dofs.clone()]))
            {
                (joint[1].diagonal, joint[1].x) = (joint[0].diagonal + b, *x);
            }
            let tree = Tree { span, links, cdof: rows(&d.cdof) };
            tree.factor::<1, 2, true>(rows(&d.cinert), bodies, joints);
            tree.fall::<1, 2>(bodies, joints);
            get::<1>(joints, dofs, x);
        } else {
            solve_rows_with(m, &d.M, b, [&mut w.ld, &mut w.diag_inv], dofs, x);
        }
    }
}

#[cfg_attr(not(feature = "small"), inline(always))]
fn wide(s: &Spatial) -> Wide {
    [s[0], s[1], s[2], s[3], s[4], s[5], 0.0, 0.0]
}

#[cfg_attr(not(feature = "small"), inline(always))]
fn narrow(w: &Wide) -> Spatial {
    [w[0], w[1], w[2], w[3], w[4], w[5]]
}

/// a · b, lane by lane.
#[cfg_attr(not(feature = "small"), inline(always))]
fn dot(a: Wide, b: Wide) -> f64 {
    let s: [f64; 4] = std::array::from_fn(|i| a[i] * b[i] + a[i + 4] * b[i + 4]);
    (s[0] + s[2]) + (s[1] + s[3])
}

/// An inertia as a symmetric matrix, by columns, whose last rows stay zero.
#[inline(never)] // see `eliminate`
fn set_inertia(to: &mut [Wide; 6], i: &Inertia) {
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
fn add_to(a: &mut [Wide; 6], b: &[Wide; 6]) {
    for c in 0..6 {
        a[c] = add(a[c], b[c]);
    }
}

/// U and D of the degree of freedom s of a joint, and I ← I - U Uᵀ / D. Returns whether D is not
/// positive.
#[inline(never)] // inlined into a loop, the compiler would not add lane by lane
fn eliminate(i: &mut [Wide; 6], s: &Spatial, joint: &mut Joint) -> bool {
    // In three sums, each of which is soon done: the next degree of freedom waits for U.
    let part = |c: usize| add_scaled(scale(i[c], s[c]), i[c + 1], s[c + 1]);
    let u = add(add(part(0), part(2)), part(4));
    let d = joint.diagonal + dot(wide(s), u);
    let inv = 1.0 / d.max(MINVAL);
    let v = scale(u, -inv);
    for c in 0..6 {
        i[c] = add_scaled(i[c], u, v[c]);
    }
    (joint.u, joint.inv) = (u, inv);
    d < MINVAL
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::panic)]

    use super::*;
    use crate::kinds::joint;
    use crate::mjcf::compile;
    use crate::step::forward::forward;
    use crate::step::workspace::Data;
    use proptest::prelude::*;

    /// A tree as text: of each body its parent, its joints (-1 for none, three hinges at most), its place and turn.
    fn text(bodies: &[(usize, i32, [f64; 3])]) -> String {
        fn body(i: usize, bodies: &[(usize, i32, [f64; 3])], free: bool) -> String {
            let (_, joints, [x, y, z]) = bodies[i];
            let joints = match joints {
                _ if i == 0 && free => "<freejoint/>".into(),
                -1 if i > 0 => String::new(),
                0 => "<joint type='ball' armature='0.02'/>".into(),
                1 => "<joint type='slide' axis='1 2 0' armature='0.1'/>".into(),
                n => ["1 0 0", "0 1 0.2", "0.3 0 1"][..(n.max(2) - 1) as usize]
                    .iter()
                    .map(|axis| format!("<joint axis='{axis}' pos='0.05 0 0.02' damping='0.3'/>"))
                    .collect(),
            };
            let children = (i + 1..bodies.len()).filter(|&c| bodies[c].0.min(c - 1) == i);
            let children: String = children.map(|c| body(c, bodies, free)).collect();
            format!(
                "<body pos='{x} {y} {z}' euler='{} {} 20'>{joints}<geom type='box' size='0.1 0.07 0.05' pos='0.04 0.1 0'/>{children}</body>",
                40.0 * x,
                30.0 * z
            )
        }
        format!(
            "<mujoco><option gravity='1 2 -9'/><worldbody>{}<body><freejoint/><geom size='0.1'/></body>{}</worldbody></mujoco>",
            body(0, bodies, true),
            body(0, bodies, false)
        )
    }

    proptest! {
        #[test]
        fn an_articulated_tree_is_that_of_its_mass_matrix(
            bodies in prop::collection::vec((0usize..6, -1i32..5, prop::array::uniform3(-0.4f64..0.4)), 3..9),
            q in prop::collection::vec(-1.0f64..1.0, 80),
        ) {
            let m = compile(&text(&bodies)).unwrap();
            let mut d = Data::new(&m);
            for j in (0..m.njnt).filter(|&j| m.jnt_type[j] != joint::FREE) {
                let at = m.jnt_qposadr[j] as usize;
                d.qpos[at] += q[at % q.len()];
            }
            for (v, x) in d.qvel.iter_mut().zip(q.iter().rev()) {
                *v = *x;
            }
            forward(&m, &mut d);
            let (mut ld, mut inv) = (d.M.clone(), vec![0.0; m.nv]);
            prop_assert_eq!(mass::factor(&m, &mut ld, &mut inv, 0..m.nv), None);
            for (ours, rows) in d.qLD.iter().zip(&ld) {
                prop_assert!((ours - rows).abs() < 1e-10 * (1.0 + rows.abs()), "{ours} {rows}");
            }

            // Backwards: the force of the acceleration is the force.
            let f: Vec<f64> = (0..m.nv).map(|k| q[(3 * k) % q.len()]).collect();
            let b: Vec<f64> = (0..m.nv).map(|k| q[(5 * k) % q.len()].abs()).collect();
            let (mut x, mut back) = (f.clone(), vec![0.0; m.nv]);
            solve_with(&m, &d.fields, &mut d.work.dynamics, &b, &mut x);
            mass::mul(&m, &d.M, &x, &mut back, 0..m.nv);
            for k in 0..m.nv {
                prop_assert!((back[k] + b[k] * x[k] - f[k]).abs() < 1e-9, "{k}");
            }
            x.copy_from_slice(&f);
            solve(&m, &d.fields, &mut d.work.dynamics, &mut x);
            mass::mul(&m, &d.M, &x, &mut back, 0..m.nv);
            let size = x.iter().fold(1.0_f64, |s, x| s.max(x.abs()));
            for k in 0..m.nv {
                prop_assert!((back[k] - f[k]).abs() < 1e-9 * size, "{k}");
            }
        }
    }
}
