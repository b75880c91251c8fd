//! Trees of slides only, branched or not: carriages, gantries, fingers of grippers.
//!
//! No body rotates relative to another, so all bodies that a slide moves act as one mass. M_ij = m_i (a_i · a_j) for
//! an ancestor j of i, where m_i is the mass that slide i moves and a are the axes. The bias force is the weight,
//! -m_i (a_i · g). M changes only if masses change, or if the body that carries the tree rotates. Otherwise M and its
//! factorization are reused.

use super::{AlgorithmRow, Assignment, Damped, Factors, Forces, NOTHING};
use crate::dynamics::{DynamicsScratch, mass as rows_of_mass};
use crate::kinds::joint;
use crate::math::*;
use crate::model::reflect::model as fields_of;
use crate::model::{Fields, Model};
use std::ops::Range;

pub(super) const ROW: AlgorithmRow = AlgorithmRow {
    name: "prismatic",
    covers,
    copies: &[
        fields_of::body_mass,
        fields_of::dof_armature,
        fields_of::actuator_armature,
        fields_of::actuator_gear,
    ],
    load: |m, w| w.algorithms.prismatic.load(m),
    forces: Some(Forces {
        mass,
        bias,
        bias_uses_poses: |_, _| true,
        constant: |_, _| false,
        bias_is_free_torque: false,
    }),
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

/// Whether a tree consists of slides, none of which moves a simple body.
fn covers(m: &Model, tree: usize) -> bool {
    m.tree_dofs(tree)
        .all(|dof| m.dof_simplenum[dof] == 0 && m.jnt_type[m.dof_jntid[dof] as usize] == joint::SLIDE)
}

/// The slides of all such trees, and the trees that this algorithm factorizes.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Trees {
    slides: Vec<Slide>,
    /// Whether the stored rows of M correspond to the current masses.
    is_current: bool,
    /// The mass of each body, and that of each body with its descendants.
    masses: Vec<f64>,
    carried: Vec<f64>,
    factored: Vec<FactoredTree>,
}

/// A slide.
#[derive(Clone, Debug, Default, PartialEq)]
struct Slide {
    dof: usize,
    joint: usize,
    body: usize,
    mass: f64,
    armature: f64,
    /// Its axis (world frame) and its row of M.
    axis: Vec3,
    row: Vec<f64>,
}

/// A tree, and its factorization with the M that it was computed from.
#[derive(Clone, Debug, Default, PartialEq)]
struct FactoredTree {
    dofs: Range<usize>,
    /// The range of its rows of M.
    rows: Range<usize>,
    matrix: Vec<f64>,
    ld: Vec<f64>,
    diag_inv: Vec<f64>,
}

impl Trees {
    pub(super) fn new(m: &Model, assignment: &Assignment) -> Trees {
        let slide = |dof: usize| {
            let joint = m.dof_jntid[dof] as usize;
            let row = vec![0.0; rows_of_mass::row(m, dof).len()];
            Slide { dof, joint, body: m.jnt_bodyid[joint] as usize, row, ..Slide::default() }
        };
        let slides = assignment.forces.iter().flat_map(|&tree| m.tree_dofs(tree)).map(slide).collect();
        let tree = |&tree: &usize| {
            let dofs = m.tree_dofs(tree);
            FactoredTree { rows: rows_of_mass::rows_of(m, dofs.clone()), dofs, ..FactoredTree::default() }
        };
        let factored = assignment.factors.iter().map(tree).collect();
        let mut trees = Trees { slides, factored, ..Trees::default() };
        trees.load(m);
        trees
    }

    /// Reads masses and armatures from the model.
    fn load(&mut self, m: &Model) {
        if self.slides.is_empty() {
            return;
        }
        if !same_bits(&self.masses, &m.body_mass) {
            self.masses.clone_from(&m.body_mass);
            self.carried.clone_from(&m.body_mass);
            for b in (1..m.nbody).rev() {
                self.carried[m.body_parentid[b] as usize] += self.carried[b];
            }
        }
        for slide in &mut self.slides {
            let (mass, armature) = (self.carried[slide.body], rows_of_mass::armature(m, slide.dof));
            self.is_current &= (slide.mass, slide.armature) == (mass, armature);
            (slide.mass, slide.armature) = (mass, armature);
        }
    }

    /// Computes the rows of M again if masses or axes have changed.
    fn update(&mut self, m: &Model, axes: &[Vec3]) {
        if self.is_current && self.slides.iter().all(|slide| same_bits(&slide.axis, &axes[slide.joint])) {
            return;
        }
        for slide in &mut self.slides {
            slide.axis = axes[slide.joint];
            let along = scale(slide.axis, slide.mass);
            let columns = m.M_colind[rows_of_mass::row(m, slide.dof)].iter();
            slide.row.clear();
            slide.row.extend(columns.map(|&k| dot(along, axes[m.dof_jntid[k as usize] as usize])));
            if let Some(diagonal) = slide.row.last_mut() {
                *diagonal += slide.armature;
            }
        }
        self.is_current = true;
    }
}

fn mass(m: &Model, d: &mut Fields, w: &mut DynamicsScratch) {
    let trees = &mut w.algorithms.prismatic;
    trees.update(m, rows::<3>(&d.xaxis));
    for slide in &trees.slides {
        d.M[rows_of_mass::row(m, slide.dof)].copy_from_slice(&slide.row);
    }
}

fn bias(_: &Model, d: &mut Fields, w: &mut DynamicsScratch, gravity: Vec3) {
    let axes = rows::<3>(&d.xaxis);
    for slide in &w.algorithms.prismatic.slides {
        d.qfrc_bias[slide.dof] = -slide.mass * dot(gravity, axes[slide.joint]);
    }
}

fn factor(m: &Model, d: &mut Fields, w: &mut DynamicsScratch) -> Option<usize> {
    let mut bad = None;
    for tree in &mut w.algorithms.prismatic.factored {
        let (rows, dofs) = (tree.rows.clone(), tree.dofs.clone());
        if same_bits(&tree.matrix, &d.M[rows.clone()]) {
            d.qLD[rows].copy_from_slice(&tree.ld);
            d.qLDiagInv[dofs].copy_from_slice(&tree.diag_inv);
            continue;
        }
        let failed = rows_of_mass::factor_copy(m, &d.M, &mut d.qLD, &mut d.qLDiagInv, dofs.clone());
        // A failed factorization is not reused, so that the next step warns again.
        tree.matrix.clear();
        if failed.is_none() {
            tree.matrix.extend_from_slice(&d.M[rows.clone()]);
            tree.ld.clear();
            tree.ld.extend_from_slice(&d.qLD[rows]);
            tree.diag_inv.clear();
            tree.diag_inv.extend_from_slice(&d.qLDiagInv[dofs]);
        }
        bad = bad.or(failed);
    }
    bad
}

fn solve(m: &Model, d: &Fields, w: &mut DynamicsScratch, x: &mut [f64]) {
    for tree in &w.algorithms.prismatic.factored {
        rows_of_mass::solve(m, &d.qLD, &d.qLDiagInv, x, tree.dofs.clone());
    }
}

fn solve_with(m: &Model, d: &Fields, w: &mut DynamicsScratch, b: &[f64], x: &mut [f64]) {
    for tree in &w.algorithms.prismatic.factored {
        let dofs = tree.dofs.clone();
        rows_of_mass::solve_with(m, &d.M, b, [&mut w.ld, &mut w.diag_inv], dofs, x);
    }
}

fn factor_and_solve(m: &Model, d: &mut Fields, w: &mut DynamicsScratch, x: &mut [f64]) -> Option<usize> {
    let bad = factor(m, d, w);
    solve(m, d, w, x);
    bad
}

fn solve_both(m: &Model, d: &mut Fields, w: &mut DynamicsScratch, (b, x, y): Damped<'_>) -> Option<usize> {
    solve_with(m, d, w, b, y);
    factor_and_solve(m, d, w, x)
}
