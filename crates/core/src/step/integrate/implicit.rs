//! Implicit in velocity: (M - h D) a' = f, where D is the derivative of the smooth forces f with respect to
//! velocities (Hairer and Wanner 1996, *Solving Ordinary Differential Equations II*, section IV.7).

use super::{Slopes, advance};
use crate::dynamics::mass;
use crate::forces::{derivative, derivative::Medium, derivative::sparse};
use crate::math::{MINVAL, Spatial};
use crate::{Data, Model, Warning};

/// All of D.
pub(super) fn implicit(m: &Model, d: &mut Data) {
    let mut w = std::mem::take(&mut d.work.derivative);
    derivative::forces(m, d, &mut w, Medium::Whole);
    derivative::subtract_bias(m, d, &mut w);
    sparse::mass_minus(m, &d.M, m.opt.timestep, &mut w.whole);
    if let Some(dof) = sparse::factor(m, &mut w.whole) {
        d.warn(Warning::Inertia, dof);
    }
    let mut acceleration = force(d);
    sparse::solve(m, &w.whole, &mut acceleration);
    d.work.derivative = w;
    advance(m, d, Slopes { acceleration: Some(&acceleration), ..Slopes::default() });
    d.work.qacc = acceleration;
}

/// D without the bias force, its lower triangle for both: a symmetric matrix. Rigid bodies that move freely are
/// solved with all of D, six by six.
pub(super) fn implicitfast(m: &Model, d: &mut Data) {
    let mut w = std::mem::take(&mut d.work.derivative);
    let h = m.opt.timestep;
    derivative::forces(m, d, &mut w, Medium::Symmetric);
    let mut ld = std::mem::take(&mut d.work.ld);
    ld.copy_from_slice(&d.M);
    sparse::subtract_lower(m, &w.whole, h, &mut ld);
    let free = || (0..m.ntree).filter(|&t| derivative::is_free_rigid(m, t));
    for t in free() {
        // What is solved by itself is not to spoil the rest.
        let dofs = derivative::tree_dofs(m, t);
        let rows = m.M_rowadr[dofs.start] as usize..mass::diagonal(m, dofs.end - 1) + 1;
        ld[rows.clone()].copy_from_slice(&d.M[rows]);
    }
    if let Some(dof) = mass::factor(m, &mut ld, &mut d.work.diag_inv, 0..m.nv) {
        d.warn(Warning::Inertia, dof);
    }
    let mut acceleration = force(d);
    mass::solve(m, &ld, &d.work.diag_inv, &mut acceleration, 0..m.nv);
    for t in free() {
        derivative::subtract_tree_bias(m, d, &mut w, t);
        let first = m.tree_dofadr[t] as usize;
        let mut f: Spatial = std::array::from_fn(|r| d.qfrc_smooth[first + r] + d.qfrc_constraint[first + r]);
        let mut a = derivative::free_block(m, &d.M, &w, h, first);
        if solve_six(&mut a, &mut f) {
            acceleration[first..first + 6].copy_from_slice(&f);
        }
    }
    (d.work.derivative, d.work.ld) = (w, ld);
    advance(m, d, Slopes { acceleration: Some(&acceleration), ..Slopes::default() });
    d.work.qacc = acceleration;
}

/// All forces, in an array that belongs to `d.work.qacc`.
fn force(d: &mut Data) -> Vec<f64> {
    let mut out = std::mem::take(&mut d.work.qacc);
    for (o, (f, c)) in out.iter_mut().zip(d.qfrc_smooth.iter().zip(&d.qfrc_constraint)) {
        *o = f + c;
    }
    out
}

/// x ← a⁻¹ x by Gauss' elimination with the largest pivots; `false` for a singular matrix.
pub(super) fn solve_six(a: &mut [Spatial; 6], x: &mut Spatial) -> bool {
    for k in 0..6 {
        let mut best = k;
        for r in k + 1..6 {
            if a[r][k].abs() > a[best][k].abs() {
                best = r;
            }
        }
        a.swap(k, best);
        x.swap(k, best);
        if a[k][k].abs() < MINVAL {
            return false;
        }
        for r in k + 1..6 {
            let factor = a[r][k] / a[k][k];
            for c in k + 1..6 {
                a[r][c] -= factor * a[k][c];
            }
            x[r] -= factor * x[k];
        }
    }
    for k in (0..6).rev() {
        for c in k + 1..6 {
            x[k] -= a[k][c] * x[c];
        }
        x[k] /= a[k][k];
    }
    true
}
