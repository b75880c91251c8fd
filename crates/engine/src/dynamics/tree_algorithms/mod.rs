//! The table of tree algorithms, which compute the dynamics of kinematic trees.
//!
//! Three parts are computed for each tree: the poses of its bodies ([`PoseFunctions`]), M and the bias force ([`Forces`]),
//! and accelerations from forces by a factorization of M ([`Factors`]). The general algorithm, which is the last row,
//! computes all three for any tree. A specialized algorithm computes some of them, for trees of its kind, in less
//! time. For each part, each tree uses the first row of the table that covers it. The assignment depends only on the
//! structure of the model when data are created, never on a plan.
//!
//! # Adding an algorithm
//!
//! An algorithm consists of one file in this folder and one row of the table:
//!
//! * The file contains `covers` (which trees it supports), `Trees` with `Trees::new` (its state, kept between steps),
//!   its functions, and the row `ROW`, which contains the name of the algorithm and its functions.
//! * Its `mod` and its name are added below. In the table it precedes slower algorithms.
//!
//! No other code contains names of algorithms: plans, steps and `labspec bench --without NAME` use the table. Any
//! specialized algorithm can be disabled ([`TreeAlgorithms`]). `tests/tree_algorithms.rs` does so for each row and
//! compares it with the general algorithm. `docs/measured/speed.md` lists the measured speedup of each.

use super::DynamicsScratch;
use crate::kinds::disable;
use crate::math::Vec3;
use crate::model::reflect::FieldId;
use crate::model::tree_algorithm::{TreeAlgorithm, TreeAlgorithms};
use crate::model::{Fields, Model};

/// Generates the table from its rows. Each row is a module with `ROW` and `Trees`.
macro_rules! table {
    ($($algorithm:ident)*) => {
        static TABLE: [AlgorithmRow; [$(stringify!($algorithm)),*].len()] = [$($algorithm::ROW),*];

        /// State of each algorithm, and which algorithms have trees.
        #[derive(Clone, Debug, Default, PartialEq)]
        pub(crate) struct AlgorithmStates {
            selected: Selected,
            $($algorithm: $algorithm::Trees,)*
        }

        impl AlgorithmStates {
            /// Assigns the trees of a model to algorithms and creates their states.
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

pub(crate) use diagonal_inertia::gyroscopic_jacobian;

/// An algorithm.
struct AlgorithmRow {
    /// Its name in `labspec bench`.
    name: &'static str,
    /// Whether it supports a tree.
    covers: fn(&Model, usize) -> bool,
    /// Fields of the model that its state has copies of, and the function that reads them again.
    copies: &'static [FieldId],
    load: fn(&Model, &mut DynamicsScratch),
    /// The parts that it computes; `None` for the others.
    places: Option<PoseFunctions>,
    forces: Option<Forces>,
    factors: Option<Factors>,
}

/// An algorithm that computes nothing: the base of rows, which set what differs.
const NOTHING: AlgorithmRow = AlgorithmRow {
    name: "",
    covers: |_, _| false,
    copies: &[],
    load: |_, _| {},
    places: None,
    forces: None,
    factors: None,
};

/// Computes the poses of bodies.
struct PoseFunctions {
    /// `xpos xmat xipos ximat xanchor xaxis`.
    forward_kinematics: fn(&Model, &mut Fields, &mut DynamicsScratch),
    /// `xquat`, after `forward_kinematics`.
    orientations: fn(&mut Fields, &mut DynamicsScratch),
}

/// Computes M and the bias force.
struct Forces {
    /// The rows of M.
    mass: fn(&Model, &mut Fields, &mut DynamicsScratch),
    /// Computes `qfrc_bias` for an acceleration of gravity.
    bias: fn(&Model, &mut Fields, &mut DynamicsScratch, Vec3),
    /// Whether the bias force of a tree depends on the poses of its bodies.
    bias_uses_poses: fn(&Model, usize) -> bool,
    /// Whether M of a tree is diagonal and constant.
    constant: fn(&Model, usize) -> bool,
    /// Whether the bias force of a free body is a torque that depends only on its angular velocity (`gyroscopic_jacobian`).
    bias_is_free_torque: bool,
}

/// Computes accelerations from forces. Functions that factorize return the first degree of freedom whose D is not
/// positive.
struct Factors {
    /// Whether it does not read M.
    without_mass: bool,
    /// Computes `qLD` and `qLDiagInv`. It may leave this to `complete` if only constraints read them.
    factor: fn(&Model, &mut Fields, &mut DynamicsScratch) -> Option<usize>,
    /// Computes what `factor` deferred.
    complete: fn(&Model, &mut Fields, &mut DynamicsScratch),
    /// x ← M⁻¹ x, using the result of `factor`.
    solve: fn(&Model, &Fields, &mut DynamicsScratch, &mut [f64]),
    /// x ← (M + B)⁻¹ x for a diagonal matrix B (nv), after `factor`.
    solve_with: fn(&Model, &Fields, &mut DynamicsScratch, &[f64], &mut [f64]),
    /// Factorizes and solves x ← M⁻¹ x at once, if `qLD` is not read.
    factor_and_solve: fn(&Model, &mut Fields, &mut DynamicsScratch, &mut [f64]) -> Option<usize>,
    /// Factorizes and solves x ← M⁻¹ x and y ← (M + B)⁻¹ y at once, if `qLD` is not read.
    solve_both: fn(&Model, &mut Fields, &mut DynamicsScratch, Damped<'_>) -> Option<usize>,
}

/// B, x and y.
type Damped<'a> = (&'a [f64], &'a mut [f64], &'a mut [f64]);

/// For each part, the algorithms that have trees.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Selected {
    places: TreeAlgorithms,
    forces: TreeAlgorithms,
    factors: TreeAlgorithms,
}

/// For each part, the trees of one algorithm, in order.
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

    /// All algorithms, the general one last.
    pub fn all() -> impl Iterator<Item = TreeAlgorithm> {
        (0..TABLE.len() as u8).map(TreeAlgorithm)
    }

    /// The name of the algorithm.
    pub fn name(self) -> &'static str {
        TABLE.get(usize::from(self.0)).map_or("", |row| row.name)
    }
}

impl std::fmt::Debug for TreeAlgorithm {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

/// Index of the general algorithm, the last row.
const GENERAL: usize = TABLE.len() - 1;

// `TreeAlgorithms` has a bit for each row.
const _: () = assert!(TABLE.len() <= u8::BITS as usize);

/// The row that a tree uses for the part that `computes` tests.
fn row_of(
    m: &Model,
    algorithms: TreeAlgorithms,
    tree: usize,
    computes: impl Fn(&AlgorithmRow) -> bool,
) -> usize {
    let takes = |i: &usize| {
        algorithms.has(TreeAlgorithm(*i as u8))
            && !m.tree_dofs(tree).is_empty()
            && computes(&TABLE[*i])
            && (TABLE[*i].covers)(m, tree)
    };
    (0..GENERAL).find(takes).unwrap_or(GENERAL)
}

/// Assigns the trees of a model to algorithms.
fn sort(m: &Model, algorithms: TreeAlgorithms) -> (Selected, [Assignment; TABLE.len()]) {
    // The general algorithm always runs for poses and forces: some bodies belong to no tree, and its results for
    // bodies may be read.
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

// Functions for plans.

/// The row that computes M and the bias force of a tree. `row_of` never returns a row without this part.
fn forces(m: &Model, algorithms: TreeAlgorithms, tree: usize) -> (usize, Option<&'static Forces>) {
    let row = row_of(m, algorithms, tree, |row| row.forces.is_some());
    (row, TABLE[row].forces.as_ref())
}

/// The algorithms of a tree, for its poses, its forces and its factorization.
pub fn selected_for(m: &Model, algorithms: TreeAlgorithms, tree: usize) -> [TreeAlgorithm; 3] {
    [
        row_of(m, algorithms, tree, |row| row.places.is_some()),
        row_of(m, algorithms, tree, |row| row.forces.is_some()),
        row_of(m, algorithms, tree, |row| row.factors.is_some()),
    ]
    .map(|row| TreeAlgorithm(row as u8))
}

/// Whether any tree needs composite bodies and recursion for M and the bias force.
pub(crate) fn need_composite_bodies(m: &Model, algorithms: TreeAlgorithms) -> bool {
    (0..m.ntree).any(|tree| forces(m, algorithms, tree).0 == GENERAL)
}

/// Whether the bias force of any tree depends on the poses of its bodies.
pub(crate) fn bias_depends_on_poses(m: &Model, algorithms: TreeAlgorithms) -> bool {
    (0..m.ntree).any(|tree| forces(m, algorithms, tree).1.is_some_and(|f| (f.bias_uses_poses)(m, tree)))
}

/// Whether M of the whole model is diagonal and constant.
pub fn are_constant(m: &Model, algorithms: TreeAlgorithms) -> bool {
    (0..m.ntree).all(|tree| forces(m, algorithms, tree).1.is_some_and(|f| (f.constant)(m, tree)))
}

/// Whether the bias force of a tree is a torque that depends only on the angular velocity of its one free body. Its
/// derivative with respect to velocity then needs no composite bodies.
pub(crate) fn bias_is_free_torque(m: &Model, algorithms: TreeAlgorithms, tree: usize) -> bool {
    forces(m, algorithms, tree).1.is_some_and(|f| f.bias_is_free_torque)
}

/// Whether all accelerations are computed without the rows of M of the general algorithm.
pub(crate) fn solve_without_mass_rows(m: &Model, algorithms: TreeAlgorithms) -> bool {
    (0..m.ntree).all(|tree| {
        let factors = row_of(m, algorithms, tree, |row| row.factors.is_some());
        forces(m, algorithms, tree).0 != GENERAL
            || TABLE[factors].factors.as_ref().is_some_and(|f| f.without_mass)
    })
}

/// The fields of the model that algorithms have copies of.
pub fn copied() -> impl Iterator<Item = FieldId> {
    TABLE.iter().flat_map(|row| row.copies).copied()
}

/// Reads the parameters of all algorithms from the model: when data are created, and after a field that they have
/// copies of was written.
pub fn load(m: &Model, w: &mut DynamicsScratch) {
    TABLE.iter().for_each(|row| (row.load)(m, w));
}

/// The trees of a model that are long planar chains, determined when the model is compiled.
pub fn planar_trees(m: &Model) -> Vec<i32> {
    (0..m.ntree).filter(|&tree| planar_chain::is_planar(m, tree)).map(|tree| tree as i32).collect()
}

/// Whether all the given trees, which come from a stored model, are chains.
pub(crate) fn are_chains(m: &Model, trees: &[i32]) -> bool {
    let chain = |&t: &i32| usize::try_from(t).is_ok_and(|t| t < m.ntree && planar_chain::is_chain(m, t));
    trees.iter().all(chain)
}

/// Whether some trees compute their rows of M only when they are read.
pub(crate) fn defers_mass_rows(w: &DynamicsScratch) -> bool {
    !w.algorithms.planar_chain.is_empty()
}

// Functions for steps. Each calls the corresponding function of all algorithms that have trees.

/// Calls a function of every algorithm that has trees for a part, from the last row of the table, the general one, to
/// the first. Specialized algorithms overwrite what the general one computes for all bodies.
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

/// Computes the poses of bodies and joints: `xpos xmat xipos ximat xanchor xaxis`.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn forward_kinematics(m: &Model, d: &mut Fields, w: &mut DynamicsScratch) {
    each!(w, places, |_algorithm, row, functions| (functions.forward_kinematics)(m, d, w));
}

/// Computes the orientations of bodies as quaternions, `xquat`, after [`forward_kinematics`].
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn orientations(d: &mut Fields, w: &mut DynamicsScratch) {
    each!(w, places, |_algorithm, row, functions| (functions.orientations)(d, w));
}

/// Computes `M`. `general` selects whether this includes the rows of the general algorithm, and `rows` the rows of
/// algorithms that can defer them.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn mass(m: &Model, d: &mut Fields, w: &mut DynamicsScratch, general: bool, rows: bool) {
    w.needs_mass_rows = rows;
    each!(w, forces, |algorithm, row, functions| {
        if algorithm.0 != GENERAL as u8 || general {
            (functions.mass)(m, d, w);
        }
    });
}

/// Computes `qfrc_bias`: gravity, Coriolis and centrifugal forces.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn bias(m: &Model, d: &mut Fields, w: &mut DynamicsScratch) {
    let gravity = if m.opt.disabled(disable::GRAVITY) { [0.0; 3] } else { m.opt.gravity };
    each!(w, forces, |_algorithm, row, functions| (functions.bias)(m, d, w, gravity));
}

/// Computes `qLD` and `qLDiagInv`, the factorization of M. Returns the first degree of freedom whose D is not
/// positive, like the functions below.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn factor(m: &Model, d: &mut Fields, w: &mut DynamicsScratch) -> Option<usize> {
    let mut bad = None;
    each!(w, factors, |_algorithm, row, functions| bad = first(bad, (functions.factor)(m, d, w)));
    bad
}

/// Computes the part of `qLD` and `qLDiagInv` that [`factor`] deferred, for constraints that read it. Few steps need
/// it.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn complete(m: &Model, d: &mut Fields, w: &mut DynamicsScratch) {
    if w.rows_due {
        w.rows_due = false;
        each!(w, factors, |_algorithm, row, functions| (functions.complete)(m, d, w));
    }
}

/// x ← M⁻¹ x, using the result of [`factor`].
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn solve(m: &Model, d: &Fields, w: &mut DynamicsScratch, x: &mut [f64]) {
    each!(w, factors, |_algorithm, row, functions| (functions.solve)(m, d, w, x));
}

/// x ← (M + B)⁻¹ x for a diagonal matrix B (nv), after [`factor`].
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn solve_with(m: &Model, d: &Fields, w: &mut DynamicsScratch, b: &[f64], x: &mut [f64]) {
    each!(w, factors, |_algorithm, row, functions| (functions.solve_with)(m, d, w, b, x));
}

/// Factorizes and solves x ← M⁻¹ x at once, without a call of [`factor`].
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn factor_and_solve(
    m: &Model,
    d: &mut Fields,
    w: &mut DynamicsScratch,
    x: &mut [f64],
) -> Option<usize> {
    let mut bad = None;
    each!(w, factors, |_algorithm, row, functions| bad =
        first(bad, (functions.factor_and_solve)(m, d, w, x)));
    bad
}

/// Factorizes and solves x ← M⁻¹ x and y ← (M + B)⁻¹ y for a diagonal matrix B (nv), without a call of [`factor`].
/// This is faster than two separate solutions.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn solve_both(
    m: &Model,
    d: &mut Fields,
    w: &mut DynamicsScratch,
    b: &[f64],
    x: &mut [f64],
    y: &mut [f64],
) -> Option<usize> {
    let mut bad = None;
    each!(w, factors, |_algorithm, row, functions| bad =
        first(bad, (functions.solve_both)(m, d, w, (b, &mut *x, &mut *y))));
    bad
}

/// The smaller of two optional degrees of freedom.
#[cfg_attr(not(feature = "small"), inline(always))]
fn first(a: Option<usize>, b: Option<usize>) -> Option<usize> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.min(b)),
        (a, b) => a.or(b),
    }
}
