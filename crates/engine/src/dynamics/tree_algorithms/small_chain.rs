//! Trees of at most three degrees of freedom in series, starting at the root. Most labs consist of such trees.
//!
//! Their rows of M form a packed lower triangle, which is factorized and solved with sizes known at compile time
//! (`triangle`).

use super::{AlgorithmRow, Assignment, Damped, Factors, NOTHING};
use crate::dynamics::DynamicsScratch;
use crate::dynamics::triangle::{
    by_size, factor as factor_triangle, part, part_mut, size_before, solve as solve_triangle, solve_at,
};
use crate::model::{Fields, Model};

pub(super) const ROW: AlgorithmRow = AlgorithmRow {
    name: "small_chain",
    covers,
    factors: Some(Factors {
        without_mass: false,
        factor,
        complete: |_, _, _| {},
        solve,
        solve_with,
        factor_and_solve,
        solve_both,
    }),
    ..NOTHING
};

/// Whether a tree is a small chain.
fn covers(m: &Model, tree: usize) -> bool {
    let dofs = m.tree_dofs(tree);
    size_before(m, dofs.end) == Some(dofs.len())
}

/// The trees of this algorithm.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Trees {
    trees: Vec<Tree>,
}

/// A tree: its first degree of freedom, the number of its degrees of freedom, and the start of its rows of M.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Tree {
    first: usize,
    size: usize,
    row: usize,
}

impl Trees {
    pub(super) fn new(m: &Model, assignment: &Assignment) -> Trees {
        let tree = |&tree: &usize| {
            let dofs = m.tree_dofs(tree);
            Tree { first: dofs.start, size: dofs.len(), row: m.M_rowadr[dofs.start] as usize }
        };
        Trees { trees: assignment.factors.iter().map(tree).collect() }
    }
}

#[cfg_attr(not(feature = "small"), inline(always))]
fn factor(_: &Model, d: &mut Fields, w: &mut DynamicsScratch) -> Option<usize> {
    let mut bad = None;
    for tree in &w.algorithms.small_chain.trees {
        bad = bad.or(tree.factor(&d.M, &mut d.qLD, &mut d.qLDiagInv, None));
    }
    bad
}

#[cfg_attr(not(feature = "small"), inline(always))]
fn solve(_: &Model, d: &Fields, w: &mut DynamicsScratch, x: &mut [f64]) {
    for tree in &w.algorithms.small_chain.trees {
        tree.solve(d, x);
    }
}

#[cfg_attr(not(feature = "small"), inline(always))]
fn solve_with(_: &Model, d: &Fields, w: &mut DynamicsScratch, b: &[f64], x: &mut [f64]) {
    for tree in &w.algorithms.small_chain.trees {
        tree.solve_with(&d.M, b, x);
    }
}

#[cfg_attr(not(feature = "small"), inline(always))]
fn factor_and_solve(_: &Model, d: &mut Fields, w: &mut DynamicsScratch, x: &mut [f64]) -> Option<usize> {
    let mut bad = None;
    for tree in &w.algorithms.small_chain.trees {
        bad = bad.or(tree.factor(&d.M, &mut d.qLD, &mut d.qLDiagInv, Some(&mut *x)));
    }
    bad
}

#[cfg_attr(not(feature = "small"), inline(always))]
fn solve_both(_: &Model, d: &mut Fields, w: &mut DynamicsScratch, (b, x, y): Damped<'_>) -> Option<usize> {
    let mut bad = None;
    for tree in &w.algorithms.small_chain.trees {
        bad = bad.or(tree.factor(&d.M, &mut d.qLD, &mut d.qLDiagInv, Some(&mut *x)));
        tree.solve_with(&d.M, b, y);
    }
    bad
}

impl Tree {
    /// Computes the part of `qLD` and `qLDiagInv` for the tree. With `x`, also x ← M⁻¹ x. Returns the first degree of
    /// freedom whose D is not positive.
    #[cfg_attr(not(feature = "small"), inline(always))]
    fn factor(
        self,
        mass: &[f64],
        ld: &mut [f64],
        diag_inv: &mut [f64],
        x: Option<&mut [f64]>,
    ) -> Option<usize> {
        by_size!(self.size, factor_copy(self, mass, ld, diag_inv, x))
    }

    /// x ← M⁻¹ x, using the result of [`Tree::factor`].
    #[cfg_attr(not(feature = "small"), inline(always))]
    fn solve(self, d: &Fields, x: &mut [f64]) {
        let (Some(ld), Some(diag_inv)) = (d.qLD.get(self.row..), d.qLDiagInv.get(self.first..)) else {
            return;
        };
        by_size!(self.size, solve_at(ld, diag_inv, x, self.first));
    }

    /// x ← (M + B)⁻¹ x for a diagonal matrix B (nv).
    #[cfg_attr(not(feature = "small"), inline(always))]
    fn solve_with(self, mass: &[f64], b: &[f64], x: &mut [f64]) {
        by_size!(self.size, solve_direct(self, mass, b, x));
    }
}

#[cfg_attr(not(feature = "small"), inline(always))]
fn factor_copy<const N: usize, const T: usize>(
    tree: Tree,
    mass: &[f64],
    ld: &mut [f64],
    diag_inv: &mut [f64],
    x: Option<&mut [f64]>,
) -> Option<usize> {
    let Tree { first, row, .. } = tree;
    let (ld, diag_inv) = (part_mut(ld, row)?, part_mut(diag_inv, first)?);
    *ld = *part(mass, row)?;
    let bad = factor_triangle::<N, T>(ld, diag_inv);
    if let Some(x) = x {
        solve_triangle::<N, T>(ld, diag_inv, part_mut(x, first)?);
    }
    bad.map(|k| first + k)
}

#[cfg_attr(not(feature = "small"), inline(always))]
fn solve_direct<const N: usize, const T: usize>(tree: Tree, mass: &[f64], b: &[f64], x: &mut [f64]) {
    let Tree { first, row, .. } = tree;
    let (Some(&ld), Some(b), Some(x)) = (part(mass, row), part::<N>(b, first), part_mut(x, first)) else {
        return;
    };
    let (mut ld, mut diag_inv) = (ld, [0.0; N]);
    for k in 0..N {
        ld[k * (k + 1) / 2 + k] += b[k];
    }
    factor_triangle::<N, T>(&mut ld, &mut diag_inv);
    solve_triangle::<N, T>(&ld, &diag_inv, x);
}
