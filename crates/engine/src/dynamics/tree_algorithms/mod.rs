//! How trees are computed: the table of tree algorithms.
//!
//! Three things are computed of a tree: where its bodies are (`Places`), M with the bias force (`Forces`), and accelerations
//! from forces, by a factorization of M (`Factors`). The general algorithm, which is the last row, computes all three of
//! any tree. A specialized one computes some of them, of trees of its kind, in less time. Each tree takes, for each of the three, the first row
//! of the table that covers it; this follows from the structure of the model when data are made for it, never from a plan.
//!
//! # To add an algorithm
//!
//! One file in this folder and one row of the table:
//!
//! * the file has `covers` (which trees are of its kind), `Trees` with `Trees::new` (what it knows of its trees from one step to the
//!   next), its functions, and the row, `ROW`, which names the algorithm and its functions;
//! * its `mod` and its name in the table stand below, before those that are longer.
//!
//! Nothing else knows the names of algorithms: plans, steps and `labspec bench --without NAME` ask the table. Any specialized
//! algorithm can be disabled ([`TreeAlgorithms`]): `tests/tree_algorithms.rs` does so with each row and holds it against the general one, and
//! `docs/measured/speed.md` says what each is worth.

use super::Scratch;
use crate::kinds::disable;
use crate::math::Vec3;
use crate::model::reflect::FieldId;
use crate::model::tree_algorithm::{TreeAlgorithm, TreeAlgorithms};
use crate::model::{Fields, Model};

/// The table, from its rows: a module each, with `ROW` and `Trees`.
macro_rules! table {
    ($($algorithm:ident)*) => {
        static TABLE: [Row; [$(stringify!($algorithm)),*].len()] = [$($algorithm::ROW),*];

        /// What each algorithm keeps of its trees, and which algorithms have some.
        #[derive(Clone, Debug, Default, PartialEq)]
        pub(crate) struct AlgorithmStates {
            selected: Selected,
            $($algorithm: $algorithm::Trees,)*
        }

        impl AlgorithmStates {
            /// The trees of a model by the algorithms that compute them.
            pub(crate) fn new(m: &Model, algorithms: TreeAlgorithms) -> AlgorithmStates {
                let (selected, assignments) = sort(m, algorithms);
                let mut assignments = assignments.iter();
                AlgorithmStates { selected, $($algorithm: assignments.next().map_or_else($algorithm::Trees::default, |trees| $algorithm::Trees::new(m, trees)),)* }
            }
        }
    };
}

mod articulated;
mod chain;
mod diagonal_inertia;
mod general;
mod planar_chain;
mod planar_passes;
mod prismatic;
mod rigid;
mod small_chain;

table! {
    diagonal_inertia
    rigid
    chain
    small_chain
    prismatic
    planar_chain
    articulated
    general
}

pub(crate) use diagonal_inertia::turning_slope;

/// An algorithm.
struct Row {
    /// As it is called in `labspec bench`.
    name: &'static str,
    /// Whether a tree is of its kind.
    covers: fn(&Model, usize) -> bool,
    /// Fields of the model of which its trees keep copies, and what takes them again.
    copies: &'static [FieldId],
    load: fn(&Model, &mut Scratch),
    /// What it computes.
    places: Option<Places>,
    forces: Option<Forces>,
    factors: Option<Factors>,
}

/// An algorithm that computes nothing: rows say what they do instead.
const NOTHING: Row = Row {
    name: "",
    covers: |_, _| false,
    copies: &[],
    load: |_, _| {},
    places: None,
    forces: None,
    factors: None,
};

/// Where bodies are.
struct Places {
    /// `xpos xmat xipos ximat xanchor xaxis`.
    forward_kinematics: fn(&Model, &mut Fields, &mut Scratch),
    /// `xquat`, after `forward_kinematics`.
    orientations: fn(&mut Fields, &mut Scratch),
}

/// M and the bias force.
struct Forces {
    /// The rows of M.
    mass: fn(&Model, &mut Fields, &mut Scratch),
    /// `qfrc_bias`, for an acceleration of gravity.
    bias: fn(&Model, &mut Fields, &mut Scratch, Vec3),
    /// Whether the bias force of a tree follows from where its bodies are.
    looks_at_places: fn(&Model, usize) -> bool,
    /// Whether M of a tree is diagonal and constant.
    constant: fn(&Model, usize) -> bool,
    /// Whether the bias force of a free body is a torque that follows from its own turning alone (`turning_slope`).
    turns_alone: bool,
}

/// Accelerations from forces. Functions that factorize return the first degree of freedom whose D is not positive.
struct Factors {
    /// Whether M is not looked at.
    without_mass: bool,
    /// `qLD` and `qLDiagInv`; may be left to `complete` where only constraints look at them.
    factor: fn(&Model, &mut Fields, &mut Scratch) -> Option<usize>,
    /// What `factor` has put off.
    complete: fn(&Model, &mut Fields, &mut Scratch),
    /// x ← M⁻¹ x, by what `factor` has left.
    solve: fn(&Model, &Fields, &mut Scratch, &mut [f64]),
    /// x ← (M + B)⁻¹ x for a diagonal matrix B (nv), after `factor`.
    solve_with: fn(&Model, &Fields, &mut Scratch, &[f64], &mut [f64]),
    /// x ← M⁻¹ x at once: nobody looks at `qLD`.
    solve_now: fn(&Model, &mut Fields, &mut Scratch, &mut [f64]) -> Option<usize>,
    /// x ← M⁻¹ x and y ← (M + B)⁻¹ y at once, likewise.
    solve_both: fn(&Model, &mut Fields, &mut Scratch, Damped<'_>) -> Option<usize>,
}

/// B, x and y.
type Damped<'a> = (&'a [f64], &'a mut [f64], &'a mut [f64]);

/// The algorithms that have trees, for each of the three.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Selected {
    places: TreeAlgorithms,
    forces: TreeAlgorithms,
    factors: TreeAlgorithms,
}

/// The trees of one algorithm, for each of the three, in order.
#[derive(Clone, Debug, Default, PartialEq)]
struct Assignment {
    places: Vec<usize>,
    forces: Vec<usize>,
    factors: Vec<usize>,
}

impl TreeAlgorithm {
    /// The specialized algorithms, in the order of the table.
    pub fn short() -> impl Iterator<Item = TreeAlgorithm> {
        (0..GENERAL as u8).map(TreeAlgorithm)
    }

    /// All of them, the general one last.
    pub fn all() -> impl Iterator<Item = TreeAlgorithm> {
        (0..TABLE.len() as u8).map(TreeAlgorithm)
    }

    /// What it is called.
    pub fn name(self) -> &'static str {
        TABLE.get(usize::from(self.0)).map_or("", |row| row.name)
    }
}

impl std::fmt::Debug for TreeAlgorithm {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

/// The last row.
const GENERAL: usize = TABLE.len() - 1;

// `TreeAlgorithms` has a bit for each row.
const _: () = assert!(TABLE.len() <= u8::BITS as usize);

/// The row that a tree takes for one of the three.
fn row_of(m: &Model, algorithms: TreeAlgorithms, tree: usize, computes: impl Fn(&Row) -> bool) -> usize {
    let takes = |i: &usize| {
        algorithms.has(TreeAlgorithm(*i as u8))
            && !m.tree_dofs(tree).is_empty()
            && computes(&TABLE[*i])
            && (TABLE[*i].covers)(m, tree)
    };
    (0..GENERAL).find(takes).unwrap_or(GENERAL)
}

/// Which algorithms compute the trees of a model.
fn sort(m: &Model, algorithms: TreeAlgorithms) -> (Selected, [Assignment; TABLE.len()]) {
    // The general algorithm is always asked: bodies may be in no tree, and what it computes of bodies may be read.
    let always = TreeAlgorithms::GENERAL.with(TreeAlgorithm(GENERAL as u8));
    let mut selected = Selected { places: always, forces: always, factors: TreeAlgorithms::GENERAL };
    let mut assignments = [(); TABLE.len()].map(|()| Assignment::default());
    for tree in (0..m.ntree).filter(|&t| !m.tree_dofs(t).is_empty()) {
        let [places, forces, factors] =
            selected_for(m, algorithms, tree).map(|algorithm| usize::from(algorithm.0));
        assignments[places].places.push(tree);
        assignments[forces].forces.push(tree);
        assignments[factors].factors.push(tree);
        selected.places = selected.places.with(TreeAlgorithm(places as u8));
        selected.forces = selected.forces.with(TreeAlgorithm(forces as u8));
        selected.factors = selected.factors.with(TreeAlgorithm(factors as u8));
    }
    (selected, assignments)
}

// What plans ask.

/// What computes M and the bias force of a tree. A row without them is never chosen.
fn forces(m: &Model, algorithms: TreeAlgorithms, tree: usize) -> (usize, Option<&'static Forces>) {
    let row = row_of(m, algorithms, tree, |row| row.forces.is_some());
    (row, TABLE[row].forces.as_ref())
}

/// The algorithms that compute a tree: its places, its forces and its factors.
pub fn selected_for(m: &Model, algorithms: TreeAlgorithms, tree: usize) -> [TreeAlgorithm; 3] {
    [
        row_of(m, algorithms, tree, |row| row.places.is_some()),
        row_of(m, algorithms, tree, |row| row.forces.is_some()),
        row_of(m, algorithms, tree, |row| row.factors.is_some()),
    ]
    .map(|row| TreeAlgorithm(row as u8))
}

/// Whether M and the bias force of some tree need composite bodies and recursion.
pub(crate) fn need_bodies(m: &Model, algorithms: TreeAlgorithms) -> bool {
    (0..m.ntree).any(|tree| forces(m, algorithms, tree).0 == GENERAL)
}

/// Whether the bias force of some tree needs to know where its bodies are.
pub(crate) fn look_at_places(m: &Model, algorithms: TreeAlgorithms) -> bool {
    (0..m.ntree).any(|tree| forces(m, algorithms, tree).1.is_some_and(|f| (f.looks_at_places)(m, tree)))
}

/// Whether M of the whole model is diagonal and constant.
pub fn are_constant(m: &Model, algorithms: TreeAlgorithms) -> bool {
    (0..m.ntree).all(|tree| forces(m, algorithms, tree).1.is_some_and(|f| (f.constant)(m, tree)))
}

/// Whether the bias force of a tree is a torque that follows from the turning of its one free body: then composite bodies are not
/// needed to say how it changes with velocities.
pub(crate) fn turns_alone(m: &Model, algorithms: TreeAlgorithms, tree: usize) -> bool {
    forces(m, algorithms, tree).1.is_some_and(|f| f.turns_alone)
}

/// Whether all accelerations are found without the general rows of M.
pub(crate) fn solve_alone(m: &Model, algorithms: TreeAlgorithms) -> bool {
    (0..m.ntree).all(|tree| {
        let factors = row_of(m, algorithms, tree, |row| row.factors.is_some());
        forces(m, algorithms, tree).0 != GENERAL
            || TABLE[factors].factors.as_ref().is_some_and(|f| f.without_mass)
    })
}

/// The fields of which algorithms keep copies.
pub fn copied() -> impl Iterator<Item = FieldId> {
    TABLE.iter().flat_map(|row| row.copies).copied()
}

/// Takes what the algorithms keep from the model again: when data are made, and when a field of which they keep copies was written.
pub fn load(m: &Model, w: &mut Scratch) {
    TABLE.iter().for_each(|row| (row.load)(m, w));
}

/// The trees that are long chains in a plane, of a model that is being compiled.
pub fn planar_trees(m: &Model) -> Vec<i32> {
    (0..m.ntree).filter(|&tree| planar_chain::is_planar(m, tree)).map(|tree| tree as i32).collect()
}

/// Whether all trees that a model from elsewhere calls such chains are chains.
pub(crate) fn are_chains(m: &Model, trees: &[i32]) -> bool {
    let chain = |&t: &i32| usize::try_from(t).is_ok_and(|t| t < m.ntree && planar_chain::is_chain(m, t));
    trees.iter().all(chain)
}

/// Whether some trees put off the rows of M until somebody asks for them.
pub(crate) fn put_rows_off(w: &Scratch) -> bool {
    !w.algorithms.planar_chain.is_empty()
}

// What steps ask: each calls the functions of all algorithms that have trees.

/// Calls a function of every algorithm that has trees for one of the three, from the general one to the first of the table: what
/// that one computes of all bodies, the specialized ones write over.
macro_rules! each {
    ($w:ident, $of:ident, |$algorithm:ident, $row:ident, $functions:ident| $call:expr) => {
        for i in (0..TABLE.len()).rev() {
            let ($algorithm, $row) = (TreeAlgorithm(i as u8), &TABLE[i]);
            if let Some($functions) = &$row.$of
                && $w.algorithms.selected.$of.has($algorithm)
            {
                $call
            }
        }
    };
}

/// Poses of bodies and joints: `xpos xmat xipos ximat xanchor xaxis`.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn forward_kinematics(m: &Model, d: &mut Fields, w: &mut Scratch) {
    each!(w, places, |_algorithm, row, of| (of.forward_kinematics)(m, d, w));
}

/// Orientations of bodies as quaternions, `xquat`, after [`forward_kinematics`].
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn orientations(d: &mut Fields, w: &mut Scratch) {
    each!(w, places, |_algorithm, row, of| (of.orientations)(d, w));
}

/// `M`, with or without the rows of the general algorithm, and of those that put theirs off.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn mass(m: &Model, d: &mut Fields, w: &mut Scratch, general: bool, rows: bool) {
    w.rows_wanted = rows;
    each!(w, forces, |algorithm, row, of| {
        if algorithm.0 != GENERAL as u8 || general {
            (of.mass)(m, d, w);
        }
    });
}

/// `qfrc_bias`: gravity, Coriolis and centrifugal force.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn bias(m: &Model, d: &mut Fields, w: &mut Scratch) {
    let gravity = if m.opt.disabled(disable::GRAVITY) { [0.0; 3] } else { m.opt.gravity };
    each!(w, forces, |_algorithm, row, of| (of.bias)(m, d, w, gravity));
}

/// `qLD` and `qLDiagInv`, the factorization of M. Returns the first degree of freedom whose D is not positive: so below.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn factor(m: &Model, d: &mut Fields, w: &mut Scratch) -> Option<usize> {
    let mut bad = None;
    each!(w, factors, |_algorithm, row, of| bad = first(bad, (of.factor)(m, d, w)));
    bad
}

/// What [`factor`] has put off of `qLD` and `qLDiagInv`, for constraints that look at them: few steps do.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn complete(m: &Model, d: &mut Fields, w: &mut Scratch) {
    if w.rows_due {
        w.rows_due = false;
        each!(w, factors, |_algorithm, row, of| (of.complete)(m, d, w));
    }
}

/// x ← M⁻¹ x by what [`factor`] has left.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn solve(m: &Model, d: &Fields, w: &mut Scratch, x: &mut [f64]) {
    each!(w, factors, |_algorithm, row, of| (of.solve)(m, d, w, x));
}

/// x ← (M + B)⁻¹ x for a diagonal matrix B (nv), after [`factor`].
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn solve_with(m: &Model, d: &Fields, w: &mut Scratch, b: &[f64], x: &mut [f64]) {
    each!(w, factors, |_algorithm, row, of| (of.solve_with)(m, d, w, b, x));
}

/// x ← M⁻¹ x without what [`factor`] would leave.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn solve_now(m: &Model, d: &mut Fields, w: &mut Scratch, x: &mut [f64]) -> Option<usize> {
    let mut bad = None;
    each!(w, factors, |_algorithm, row, of| bad = first(bad, (of.solve_now)(m, d, w, x)));
    bad
}

/// x ← M⁻¹ x and y ← (M + B)⁻¹ y for a diagonal matrix B (nv), likewise: in less time than one after the other.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn solve_both(
    m: &Model,
    d: &mut Fields,
    w: &mut Scratch,
    b: &[f64],
    x: &mut [f64],
    y: &mut [f64],
) -> Option<usize> {
    let mut bad = None;
    each!(w, factors, |_algorithm, row, of| bad =
        first(bad, (of.solve_both)(m, d, w, (b, &mut *x, &mut *y))));
    bad
}

/// The first of two degrees of freedom that there may be.
#[cfg_attr(not(feature = "small"), inline(always))]
fn first(a: Option<usize>, b: Option<usize>) -> Option<usize> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.min(b)),
        (a, b) => a.or(b),
    }
}
