//! The mass matrix: composite rigid bodies, sparse factorization, products and solves.
//!
//! M is stored as the rows of its lower triangle over the chain of ancestors of each degree of freedom,
//! ancestors ascending and the diagonal last. The composite rigid body algorithm and the factorization
//! M = Lᵀ D L, which creates no fill-in on this pattern, are in Featherstone 2008, chapter 6.

use crate::math::*;
use crate::{Data, Model};
use std::ops::Range;

/// `crb` and `M`. The diagonal of simple bodies is constant: with `constant` it is taken from `dof_M0`.
pub(crate) fn composite_inertia(m: &Model, d: &mut Data, constant: bool) {
    d.crb.copy_from_slice(&d.cinert);
    let crb = rows_mut::<10>(&mut d.crb);
    for i in (1..m.nbody).rev() {
        let parent = m.body_parentid[i] as usize;
        if parent > 0 {
            crb[parent] = add(crb[parent], crb[i]);
        }
    }
    let cdof = rows::<6>(&d.cdof);
    for i in 0..m.nv {
        let end = (m.M_rowadr[i] + m.M_rownnz[i]) as usize;
        if constant && m.dof_simplenum[i] > 0 {
            d.M[end - 1] = m.dof_M0[i];
            continue;
        }
        // Momentum of the subtree for a unit velocity of this degree of freedom.
        let momentum = inertia_mul(&crb[m.dof_bodyid[i] as usize], &cdof[i]);
        for a in m.M_rowadr[i] as usize..end {
            d.M[a] = dot(cdof[m.M_colind[a] as usize], momentum);
        }
        d.M[end - 1] += m.dof_armature[i];
    }
}

/// The diagonal of M as the model knows it, for a scene whose bodies are all simple: M is constant.
pub(crate) fn constant_mass(m: &Model, d: &mut Data) {
    d.M.copy_from_slice(&m.dof_M0);
    d.qLD.copy_from_slice(&m.dof_M0);
    for i in 0..m.nv {
        d.qLDiagInv[i] = 1.0 / m.dof_M0[i];
    }
}

/// Factorizes in place, M = Lᵀ D L with unit L: `ld` holds M and becomes L below the diagonal and D on it,
/// `diag_inv` becomes 1/D. Returns the first degree of freedom whose D is not positive.
pub(crate) fn factor(m: &Model, ld: &mut [f64], diag_inv: &mut [f64]) -> Option<usize> {
    let mut bad = None;
    for k in (0..m.nv).rev() {
        let start = m.M_rowadr[k] as usize;
        let diag = start + m.M_rownnz[k] as usize - 1;
        if ld[diag] < MINVAL {
            ld[diag] = MINVAL;
            bad = Some(k);
        }
        let inv = 1.0 / ld[diag];
        diag_inv[k] = inv;
        for a in (start..diag).rev() {
            // The chain of an ancestor is a prefix of this row's columns.
            let i = m.M_colind[a] as usize;
            let row = m.M_rowadr[i] as usize;
            let factor = ld[a] * inv;
            for c in 0..m.M_rownnz[i] as usize {
                ld[row + c] -= factor * ld[start + c];
            }
        }
        for x in &mut ld[start..diag] {
            *x *= inv;
        }
    }
    bad
}

/// x ← M⁻¹ x for the degrees of freedom `dofs` (ascending, whole trees).
#[inline]
pub(crate) fn solve(m: &Model, ld: &[f64], diag_inv: &[f64], x: &mut [f64], dofs: Range<usize>) {
    if m.nC == m.nv {
        // A diagonal matrix.
        for (x, inv) in x[dofs.clone()].iter_mut().zip(&diag_inv[dofs]) {
            *x *= inv;
        }
        return;
    }
    let row = |i: usize| {
        let start = m.M_rowadr[i] as usize;
        start..start + m.M_rownnz[i] as usize - 1
    };
    for i in dofs.clone().rev() {
        let xi = x[i];
        for a in row(i) {
            x[m.M_colind[a] as usize] -= ld[a] * xi;
        }
    }
    for i in dofs {
        let mut s = x[i] * diag_inv[i];
        for a in row(i) {
            s -= ld[a] * x[m.M_colind[a] as usize];
        }
        x[i] = s;
    }
}

/// out ← M v for the degrees of freedom `dofs` (ascending, whole trees).
#[inline]
pub(crate) fn mul(m: &Model, mass: &[f64], v: &[f64], out: &mut [f64], dofs: Range<usize>) {
    if m.nC == m.nv {
        // A diagonal matrix.
        for ((out, mass), v) in out[dofs.clone()].iter_mut().zip(&mass[dofs.clone()]).zip(&v[dofs]) {
            *out = mass * v;
        }
        return;
    }
    for i in dofs {
        let start = m.M_rowadr[i] as usize;
        let diag = start + m.M_rownnz[i] as usize - 1;
        let mut s = mass[diag] * v[i];
        for a in start..diag {
            let j = m.M_colind[a] as usize;
            s += mass[a] * v[j];
            // The upper triangle: j is an ancestor of i, so its own sum is already begun.
            out[j] += mass[a] * v[i];
        }
        out[i] = s;
    }
}

/// Sum of the diagonal of M over the degrees of freedom `dofs`.
#[inline]
pub(crate) fn trace(m: &Model, mass: &[f64], dofs: Range<usize>) -> f64 {
    if m.nC == m.nv {
        return mass[dofs].iter().sum();
    }
    dofs.map(|k| mass[(m.M_rowadr[k] + m.M_rownnz[k] - 1) as usize]).sum()
}

/// M as a dense symmetric matrix, row-major (`mj_fullM`).
pub fn full_m(m: &Model, d: &Data) -> Vec<f64> {
    let n = m.nv;
    let mut out = vec![0.0; n * n];
    for i in 0..n {
        for a in m.M_rowadr[i] as usize..(m.M_rowadr[i] + m.M_rownnz[i]) as usize {
            let j = m.M_colind[a] as usize;
            out[i * n + j] = d.M[a];
            out[j * n + i] = d.M[a];
        }
    }
    out
}
