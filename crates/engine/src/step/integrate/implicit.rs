//! Implicit in velocity: (M - h D) a' = f, where D is the derivative of the smooth forces f with respect to
//! velocities (Hairer and Wanner 1996, *Solving Ordinary Differential Equations II*, section IV.7).

use super::advance_along;
use crate::dynamics::mass;
use crate::forces::derivative::{self, Medium, sparse};
use crate::math::{Spatial, solve_six};
use crate::model::{Fields, Model, Warning};
use crate::step::workspace::StepScratch;

/// The integrator `implicit`: uses the whole matrix D.
pub(super) fn implicit(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    let w = &mut s.derivative;
    derivative::forces(m, d, w, Medium::Whole);
    derivative::subtract_bias(m, d, w);
    sparse::mass_minus(m, &d.M, m.opt.timestep, &mut w.whole);
    if let Some(dof) = sparse::factor(m, &mut w.whole) {
        d.warn(Warning::Inertia, dof);
    }
    force(d, &mut s.damping.qacc);
    sparse::solve(m, &w.whole, &mut s.damping.qacc);
    advance_along(m, d, s);
}

/// The integrator `implicitfast`: D without the derivative of the bias force. The lower triangle is used for both, so that the
/// matrix is symmetric. Free rigid bodies are solved with the whole matrix D, six by six.
pub(super) fn implicitfast(m: &Model, d: &mut Fields, s: &mut StepScratch) {
    let (w, factored) = (&mut s.derivative, &mut s.factored);
    let h = m.opt.timestep;
    derivative::forces(m, d, w, Medium::Symmetric);
    if let Some(dof) = factored.make(m, &d.M, &w.whole, h) {
        d.warn(Warning::Inertia, dof);
    }
    let acceleration = &mut s.damping.qacc;
    force(d, acceleration);
    for t in 0..m.ntree {
        let dofs = m.tree_dofs(t);
        if !derivative::is_free_rigid(m, t) {
            mass::solve(m, &factored.ld, &factored.diag_inv, acceleration, dofs);
            continue;
        }
        derivative::subtract_tree_bias(m, d, w, t);
        let first = dofs.start;
        let mut f: Spatial = std::array::from_fn(|r| acceleration[first + r]);
        let mut a = derivative::free_block(m, &d.M, w, h, first);
        if solve_six(&mut a, &mut f) {
            acceleration[first..first + 6].copy_from_slice(&f);
            continue;
        }
        // If the solution of this tree fails, it is solved without D, so that the other trees are not affected.
        let (ld, diag_inv) = (&mut factored.ld, &mut factored.diag_inv);
        if let Some(dof) = mass::factor_copy(m, &d.M, ld, diag_inv, dofs.clone()) {
            d.warn(Warning::Inertia, dof);
        }
        mass::solve(m, ld, diag_inv, acceleration, dofs);
    }
    advance_along(m, d, s);
}

/// The sum of all forces.
fn force(d: &Fields, out: &mut [f64]) {
    for (o, (f, c)) in out.iter_mut().zip(d.qfrc_smooth.iter().zip(&d.qfrc_constraint)) {
        *o = f + c;
    }
}
