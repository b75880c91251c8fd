//! Trees of slides alone, however they branch: carriages, gantries, the fingers of a gripper.
//!
//! Nothing turns, so that all that a slide moves is one mass: M_ij = m_i (a_i · a_j) for an ancestor j of i, where m_i is what slide i
//! moves and a are the axes, and the bias force is weight alone, -m_i (a_i · g). M changes when its masses do; while it does not,
//! its factorization stays.

use super::{Damped, Factors, Forces, NOTHING, Own, Row};
use crate::dynamics::{Scratch, mass as rows_of_mass};
use crate::kinds::joint;
use crate::math::*;
use crate::model::{Fields, Model};
use std::ops::Range;

pub(super) const ROW: Row = Row {
    name: "sliding",
    covers,
    copies: &["body_mass", "dof_armature", "actuator_armature", "actuator_gear"],
    load: |m, w| w.ways.sliding.load(m),
    forces: Some(Forces {
        mass,
        bias,
        looks_at_places: |_, _| true,
        constant: |_, _| false,
        turns_alone: false,
    }),
    factors: Some(Factors { without_mass: false, factor, solve, solve_with, solve_now, solve_both }),
    ..NOTHING
};

/// Whether a tree is one of them: slides, none of which moves a simple body.
fn covers(m: &Model, tree: usize) -> bool {
    m.tree_dofs(tree)
        .all(|dof| m.dof_simplenum[dof] == 0 && m.jnt_type[m.dof_jntid[dof] as usize] == joint::SLIDE)
}

/// The slides of all such trees, and the trees that are factorized.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Trees {
    slides: Vec<Slide>,
    /// The mass of what each body carries, itself included.
    carried: Vec<f64>,
    factored: Vec<Factored>,
}

/// A slide.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Slide {
    dof: usize,
    joint: usize,
    body: usize,
    mass: f64,
    armature: f64,
}

/// A tree, and what its factorization was made of.
#[derive(Clone, Debug, Default, PartialEq)]
struct Factored {
    dofs: Range<usize>,
    /// Where its rows of M are.
    rows: Range<usize>,
    of: Vec<f64>,
    ld: Vec<f64>,
    diag_inv: Vec<f64>,
}

impl Trees {
    pub(super) fn new(m: &Model, own: &Own) -> Trees {
        let slide = |dof: usize| {
            let joint = m.dof_jntid[dof] as usize;
            Slide { dof, joint, body: m.jnt_bodyid[joint] as usize, ..Slide::default() }
        };
        let slides = own.forces.iter().flat_map(|&tree| m.tree_dofs(tree)).map(slide).collect();
        let tree = |&tree: &usize| {
            let dofs = m.tree_dofs(tree);
            Factored { rows: rows_of_mass::rows_of(m, dofs.clone()), dofs, ..Factored::default() }
        };
        let factored = own.factors.iter().map(tree).collect();
        let mut trees = Trees { slides, carried: Vec::new(), factored };
        trees.load(m);
        trees
    }

    /// Takes masses and armatures from the model.
    fn load(&mut self, m: &Model) {
        if self.slides.is_empty() {
            return;
        }
        self.carried.clear();
        self.carried.extend_from_slice(&m.body_mass);
        for b in (1..m.nbody).rev() {
            self.carried[m.body_parentid[b] as usize] += self.carried[b];
        }
        for slide in &mut self.slides {
            (slide.mass, slide.armature) = (self.carried[slide.body], rows_of_mass::armature(m, slide.dof));
        }
    }
}

fn mass(m: &Model, d: &mut Fields, w: &mut Scratch) {
    let axes = rows::<3>(&d.xaxis);
    for slide in &w.ways.sliding.slides {
        let row = rows_of_mass::row(m, slide.dof);
        let along = scale(axes[slide.joint], slide.mass);
        let columns = m.M_colind[row.clone()].iter();
        let row = &mut d.M[row];
        for (x, &k) in row.iter_mut().zip(columns) {
            *x = dot(along, axes[m.dof_jntid[k as usize] as usize]);
        }
        if let Some(diagonal) = row.last_mut() {
            *diagonal += slide.armature;
        }
    }
}

fn bias(_: &Model, d: &mut Fields, w: &mut Scratch, gravity: Vec3) {
    let axes = rows::<3>(&d.xaxis);
    for slide in &w.ways.sliding.slides {
        d.qfrc_bias[slide.dof] = -slide.mass * dot(gravity, axes[slide.joint]);
    }
}

fn factor(m: &Model, d: &mut Fields, w: &mut Scratch) -> Option<usize> {
    let mut bad = None;
    for tree in &mut w.ways.sliding.factored {
        let (rows, dofs) = (tree.rows.clone(), tree.dofs.clone());
        if same_bits(&tree.of, &d.M[rows.clone()]) {
            d.qLD[rows].copy_from_slice(&tree.ld);
            d.qLDiagInv[dofs].copy_from_slice(&tree.diag_inv);
            continue;
        }
        let failed = rows_of_mass::factor_copy(m, &d.M, &mut d.qLD, &mut d.qLDiagInv, dofs.clone());
        // One that warns is factorized again at the next step, and warns again.
        tree.of.clear();
        if failed.is_none() {
            tree.of.extend_from_slice(&d.M[rows.clone()]);
            tree.ld.clear();
            tree.ld.extend_from_slice(&d.qLD[rows]);
            tree.diag_inv.clear();
            tree.diag_inv.extend_from_slice(&d.qLDiagInv[dofs]);
        }
        bad = bad.or(failed);
    }
    bad
}

fn solve(m: &Model, d: &Fields, w: &mut Scratch, x: &mut [f64]) {
    for tree in &w.ways.sliding.factored {
        rows_of_mass::solve(m, &d.qLD, &d.qLDiagInv, x, tree.dofs.clone());
    }
}

fn solve_with(m: &Model, d: &Fields, w: &mut Scratch, b: &[f64], x: &mut [f64]) {
    for tree in &w.ways.sliding.factored {
        let dofs = tree.dofs.clone();
        rows_of_mass::solve_with(m, &d.M, b, [&mut w.ld, &mut w.diag_inv], dofs, x);
    }
}

fn solve_now(m: &Model, d: &mut Fields, w: &mut Scratch, x: &mut [f64]) -> Option<usize> {
    let bad = factor(m, d, w);
    solve(m, d, w, x);
    bad
}

fn solve_both(m: &Model, d: &mut Fields, w: &mut Scratch, (b, x, y): Damped<'_>) -> Option<usize> {
    solve_with(m, d, w, b, y);
    solve_now(m, d, w, x)
}
