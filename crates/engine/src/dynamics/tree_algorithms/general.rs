//! The general algorithm, which supports every tree and computes all three parts.
//!
//! Poses are computed body by body (`kinematics`). M is computed by the composite rigid body algorithm, one row for
//! each degree of freedom, and is factorized by elimination (`mass`). The bias force is computed by recursion
//! (`rne`).

use super::{AlgorithmRow, Assignment, Damped, Factors, Forces, PoseFunctions};
use crate::dynamics::kinematics::{self, Frames};
use crate::dynamics::{DynamicsScratch, mass as rows, rne};
use crate::math::Vec3;
use crate::model::plan::PlanFlag;
use crate::model::{Fields, Model};
use std::ops::Range;

pub(super) const ROW: AlgorithmRow = AlgorithmRow {
    name: "general",
    covers: |_, _| true,
    copies: &kinematics::FIELDS,
    load: |m, w| w.algorithms.general.frames.load(m),
    places: Some(PoseFunctions { forward_kinematics, orientations }),
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
};

/// Parameters of all bodies, and ranges of consecutive degrees of freedom: those whose M this algorithm computes, and
/// those that it factorizes.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Trees {
    frames: Frames,
    forces: Vec<Range<usize>>,
    factors: Vec<Range<usize>>,
}

impl Trees {
    pub(super) fn new(m: &Model, assignment: &Assignment) -> Trees {
        Trees {
            frames: Frames::new(m),
            forces: spans(m, &assignment.forces),
            factors: spans(m, &assignment.factors),
        }
    }
}

/// The degrees of freedom of the given trees, merged into few ranges.
fn spans(m: &Model, trees: &[usize]) -> Vec<Range<usize>> {
    let mut spans: Vec<Range<usize>> = Vec::new();
    for dofs in trees.iter().map(|&tree| m.tree_dofs(tree)) {
        match spans.last_mut() {
            Some(last) if last.end == dofs.start => last.end = dofs.end,
            _ => spans.push(dofs),
        }
    }
    spans
}

/// The parameters of all bodies.
pub(super) fn frames(w: &mut DynamicsScratch) -> &mut Frames {
    &mut w.algorithms.general.frames
}

fn forward_kinematics(_: &Model, d: &mut Fields, w: &mut DynamicsScratch) {
    kinematics::bodies(d, &mut w.algorithms.general.frames);
}

fn orientations(d: &mut Fields, w: &mut DynamicsScratch) {
    kinematics::orientations(d, &w.algorithms.general.frames);
}

fn mass(m: &Model, d: &mut Fields, w: &mut DynamicsScratch) {
    rows::composite_inertia(m, d, &mut w.path, &w.algorithms.general.forces);
}

fn bias(m: &Model, d: &mut Fields, w: &mut DynamicsScratch, gravity: Vec3) {
    if d.plan.has(PlanFlag::Recursion) {
        rne::newton_euler(m, d, w, gravity);
    }
}

#[inline(never)] // so that scenes with small trees do not execute its setup code; the same applies below
fn factor(m: &Model, d: &mut Fields, w: &mut DynamicsScratch) -> Option<usize> {
    let mut bad = None;
    for dofs in w.algorithms.general.factors.iter().cloned() {
        bad = bad.or(rows::factor_copy(m, &d.M, &mut d.qLD, &mut d.qLDiagInv, dofs));
    }
    bad
}

#[inline(never)]
fn solve(m: &Model, d: &Fields, w: &mut DynamicsScratch, x: &mut [f64]) {
    for dofs in w.algorithms.general.factors.iter().cloned() {
        rows::solve(m, &d.qLD, &d.qLDiagInv, x, dofs);
    }
}

#[inline(never)]
fn solve_with(m: &Model, d: &Fields, w: &mut DynamicsScratch, b: &[f64], x: &mut [f64]) {
    for dofs in w.algorithms.general.factors.iter().cloned() {
        rows::solve_with(m, &d.M, b, [&mut w.ld, &mut w.diag_inv], dofs, x);
    }
}

#[inline(never)]
fn factor_and_solve(m: &Model, d: &mut Fields, w: &mut DynamicsScratch, x: &mut [f64]) -> Option<usize> {
    let mut bad = None;
    for dofs in w.algorithms.general.factors.iter().cloned() {
        bad = bad.or(rows::factor_copy(m, &d.M, &mut d.qLD, &mut d.qLDiagInv, dofs.clone()));
        rows::solve(m, &d.qLD, &d.qLDiagInv, x, dofs);
    }
    bad
}

#[inline(never)]
fn solve_both(m: &Model, d: &mut Fields, w: &mut DynamicsScratch, (b, x, y): Damped<'_>) -> Option<usize> {
    solve_with(m, d, w, b, y);
    factor_and_solve(m, d, w, x)
}
