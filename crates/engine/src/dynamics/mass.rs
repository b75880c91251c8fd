//! The mass matrix: composite rigid bodies, sparse factorization, products and solves.
//!
//! M is stored as rows of its lower triangle. The row of a degree of freedom contains the columns of its ancestors in
//! ascending order and the diagonal as the last element. The composite rigid body algorithm and the factorization M =
//! Lᵀ D L, which creates no fill-in for this pattern, are in Featherstone 2008, chapter 6. Trees with many degrees of
//! freedom are factorized with the articulated-body algorithm (`tree_algorithms`).

use super::path::Path;
use super::reflected::{self, On};
use super::triangle;
use crate::math::lanes::total;
use crate::math::*;
use crate::model::{Fields, Model};
use std::ops::Range;
use wide::f64x4;

/// Computes `crb` of all bodies, and the rows of `M` for the given degrees of freedom (ascending, whole trees).
pub fn composite_inertia(m: &Model, d: &mut Fields, path: &mut Path, dofs: &[Range<usize>]) {
    d.crb.copy_from_slice(&d.cinert);
    let crb = rows_mut::<10>(&mut d.crb);
    for i in (1..m.nbody).rev() {
        let parent = m.body_parentid[i] as usize;
        if parent > 0 {
            crb[parent] = add(crb[parent], crb[i]);
        }
    }
    let cdof = rows::<6>(&d.cdof);
    for i in dofs.iter().cloned().flatten() {
        let row = &mut d.M[row(m, i)];
        let depth = row.len() - 1;
        // Momentum of the subtree for a unit velocity of this degree of freedom.
        let momentum = inertia_mul(&crb[m.dof_bodyid[i] as usize], &cdof[i]);
        path.extend(depth, &cdof[i]);
        path.product(&momentum, row);
        row[depth] += armature(m, i);
    }
}

/// Copies the diagonal of M from the model, for scenes with a constant diagonal M, and computes its factorization.
pub(crate) fn constant(m: &Model, d: &mut Fields) {
    d.M.copy_from_slice(&m.dof_M0);
    d.qLD.copy_from_slice(&m.dof_M0);
    for i in 0..m.nv {
        d.qLDiagInv[i] = 1.0 / m.dof_M0[i];
    }
}

/// vᵀ M v.
pub(crate) fn quadratic(m: &Model, mass: &[f64], v: &[f64]) -> f64 {
    let mut sum = 0.0;
    for i in 0..m.nv {
        let row = row(m, i);
        let Some((diagonal, rest)) = mass[row.clone()].split_last() else {
            return broken_invariant("a row of M has its diagonal");
        };
        let ancestors = m.M_colind[row].iter().zip(rest).map(|(&k, x)| x * v[k as usize]);
        sum += v[i] * (diagonal * v[i] + 2.0 * ancestors.sum::<f64>());
    }
    sum
}

/// The index range of the row of degree of freedom `i`.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn row(m: &Model, i: usize) -> Range<usize> {
    let start = m.M_rowadr[i] as usize;
    start..start + m.M_rownnz[i] as usize
}

/// The index range of the rows of the degrees of freedom `dofs`.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn rows_of(m: &Model, dofs: Range<usize>) -> Range<usize> {
    if dofs.is_empty() { 0..0 } else { row(m, dofs.start).start..row(m, dofs.end - 1).end }
}

/// Whether the rows of the degrees of freedom `dofs` consist of the diagonal only, as for simple bodies.
#[cfg_attr(not(feature = "small"), inline(always))]
fn is_diagonal(m: &Model, dofs: &Range<usize>) -> bool {
    rows_of(m, dofs.clone()).len() == dofs.len()
}

/// The armature of degree of freedom `i`: that of the joint plus the reflected inertia of actuators.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn armature(m: &Model, i: usize) -> f64 {
    let (armature, joint) = (m.dof_armature[i], m.dof_jntid[i] as usize);
    // Few joints have an actuator with inertia.
    if m.jnt_actuatorid[joint] == -1 { armature } else { armature + reflected::armature(m, On::Joint(joint)) }
}

/// Factorizes the rows of the degrees of freedom `dofs` (ascending, whole trees) in place, M = Lᵀ D L with unit L. On
/// input, `ld` contains M; on output, it contains L below the diagonal and D on it, and `diag_inv` contains 1/D.
/// Returns the first degree of freedom whose D is not positive.
///
/// The rows are processed from the last to the first. Each row is eliminated from those of its ancestors. Rows of a
/// serial chain are processed four at a time, so that the row of an ancestor is read and written once for four
/// eliminations. The operations on each element and their order do not change.
#[inline(never)]
pub fn factor(m: &Model, ld: &mut [f64], diag_inv: &mut [f64], dofs: Range<usize>) -> Option<usize> {
    if let Some(n) = whole_chain(m) {
        return triangle::factor_rows(n, ld, diag_inv);
    }
    let mut bad = None;
    if is_diagonal(m, &dofs) {
        let rows = ld[rows_of(m, dofs.clone())].iter_mut().zip(&mut diag_inv[dofs.clone()]);
        for (k, (x, inv)) in dofs.zip(rows).rev() {
            if *x < MINVAL {
                *x = MINVAL;
                bad = Some(k);
            }
            *inv = 1.0 / *x;
        }
        return bad;
    }
    let mut end = dofs.end;
    while end > dofs.start {
        if let Some(n) = triangle::size_before(m, end) {
            let first = end - n;
            let start = m.M_rowadr[first] as usize;
            let failed = triangle::factor_rows(n, &mut ld[start..], &mut diag_inv[first..]);
            bad = failed.map(|k| first + k).or(bad);
            end = first;
            continue;
        }
        let n = chain(m, end);
        if n == 1 {
            end -= 1;
            if eliminate(m, ld, diag_inv, end) {
                bad = Some(end);
            }
            continue;
        }
        bad = eliminate_four(m, ld, diag_inv, end - n).or(bad);
        end -= n;
    }
    bad
}

/// Eliminates the four rows of a serial chain, starting with row `first`, from each other, then together from those
/// of their common ancestors. Returns the first of these rows whose D is not positive.
#[cfg_attr(not(feature = "small"), inline(always))]
fn eliminate_four(m: &Model, ld: &mut [f64], diag_inv: &mut [f64], first: usize) -> Option<usize> {
    let mut bad = None;
    let end = first + 4;
    let (above, block) = ld.split_at_mut(m.M_rowadr[first] as usize);
    for k in (first..end).rev() {
        let (before, row) = block.split_at_mut(m.M_rowadr[k] as usize - m.M_rowadr[first] as usize);
        let diag = m.M_rownnz[k] as usize - 1;
        if row[diag] < MINVAL {
            row[diag] = MINVAL;
            bad = Some(k);
        }
        let inv = 1.0 / row[diag];
        diag_inv[k] = inv;
        // The other rows of the block. The chain of an ancestor is a prefix of the columns of this row.
        for i in (first..k).rev() {
            let offset = (m.M_rowadr[i] - m.M_rowadr[first]) as usize;
            let len = m.M_rownnz[i] as usize;
            let factor = row[len - 1] * inv;
            subtract(&mut before[offset..offset + len], &row[..len], factor);
        }
    }
    let depth = m.M_rownnz[first] as usize - 1;
    let ancestors = &m.M_colind[m.M_rowadr[first] as usize..][..depth];
    let [r0, r1, r2, r3] = four_rows(block, depth + 1);
    for (a, &i) in ancestors.iter().enumerate().rev() {
        let target = &mut above[m.M_rowadr[i as usize] as usize..][..a + 1];
        let inv = &diag_inv[first..first + 4];
        let factors = [r3[a] * inv[3], r2[a] * inv[2], r1[a] * inv[1], r0[a] * inv[0]];
        subtract_four(target, [r3, r2, r1, r0], factors);
    }
    let mut rest = block;
    for k in first..end {
        let (row, after) = rest.split_at_mut(m.M_rownnz[k] as usize);
        for x in row.iter_mut().rev().skip(1) {
            *x *= diag_inv[k];
        }
        rest = after;
    }
    bad
}

/// Factorizes the rows of the matrix `mass` like [`factor`], without changing `mass`.
pub(crate) fn factor_copy(
    m: &Model,
    mass: &[f64],
    ld: &mut [f64],
    diag_inv: &mut [f64],
    dofs: Range<usize>,
) -> Option<usize> {
    let entries = rows_of(m, dofs.clone());
    ld[entries.clone()].copy_from_slice(&mass[entries]);
    factor(m, ld, diag_inv, dofs)
}

/// x ← (M + B)⁻¹ x for a diagonal matrix B (nv). `ld` and `diag_inv` are scratch for the factorization.
pub(crate) fn solve_with(
    m: &Model,
    mass: &[f64],
    b: &[f64],
    [ld, diag_inv]: [&mut Vec<f64>; 2],
    dofs: Range<usize>,
    x: &mut [f64],
) {
    let entries = rows_of(m, dofs.clone());
    ld[entries.clone()].copy_from_slice(&mass[entries]);
    for k in dofs.clone() {
        ld[diagonal(m, k)] += b[k];
    }
    factor(m, ld, diag_inv, dofs.clone());
    solve(m, ld, diag_inv, x, dofs);
}

/// The number of degrees of freedom, if the whole model is one small serial tree.
#[cfg_attr(not(feature = "small"), inline(always))]
fn whole_chain(m: &Model) -> Option<usize> {
    if m.nv > 3 || m.nv == 0 { None } else { triangle::size_before(m, m.nv).filter(|&n| n == m.nv) }
}

/// Eliminates row `k` from those of its ancestors. Returns whether its D is not positive.
#[cfg_attr(not(feature = "small"), inline(always))]
fn eliminate(m: &Model, ld: &mut [f64], diag_inv: &mut [f64], k: usize) -> bool {
    let start = m.M_rowadr[k] as usize;
    let n = m.M_rownnz[k] as usize - 1;
    let (above, row) = ld.split_at_mut(start);
    let row = &mut row[..n + 1];
    let bad = row[n] < MINVAL;
    if bad {
        row[n] = MINVAL;
    }
    let inv = 1.0 / row[n];
    diag_inv[k] = inv;
    let row = &mut row[..n];
    for a in (0..n).rev() {
        // The chain of an ancestor is a prefix of the columns of this row.
        let i = m.M_rowadr[m.M_colind[start + a] as usize] as usize;
        let factor = row[a] * inv;
        subtract(&mut above[i..i + a + 1], row, factor);
    }
    for x in row {
        *x *= inv;
    }
    bad
}

/// The number of rows before `end` that are eliminated together: four of a serial chain, or one.
#[cfg_attr(not(feature = "small"), inline(always))]
fn chain(m: &Model, end: usize) -> usize {
    // For shorter rows, elimination in groups does not pay off.
    if end < 4 || m.M_rownnz[end - 1] < 8 {
        return 1;
    }
    let serial = |k: usize| m.M_rownnz[k] == m.M_rownnz[k - 1] + 1 && m.dof_parentid[k] == k as i32 - 1;
    if serial(end - 1) && serial(end - 2) && serial(end - 3) { 4 } else { 1 }
}

/// The first `len` elements of four consecutive rows. The first row has `len` elements, and each row has one more
/// than the previous one.
#[cfg_attr(not(feature = "small"), inline(always))]
fn four_rows(block: &[f64], len: usize) -> [&[f64]; 4] {
    [0, len, 2 * len + 1, 3 * len + 3].map(|start| &block[start..start + len])
}

/// target -= factor row
#[cfg_attr(not(feature = "small"), inline(always))]
fn subtract(target: &mut [f64], row: &[f64], factor: f64) {
    for (t, x) in target.iter_mut().zip(row) {
        *t -= factor * x;
    }
}

/// Subtracts four rows, one after the other, each times its factor. The rows are at least as long as the target.
#[inline(never)] // a separate function, so that the compiler knows that the rows do not overlap
fn subtract_four(target: &mut [f64], rows: [&[f64]; 4], f: [f64; 4]) {
    let n = target.len();
    let [a, b, c, d] = rows.map(|r| &r[..n]);
    for i in 0..n {
        target[i] = target[i] - f[0] * a[i] - f[1] * b[i] - f[2] * c[i] - f[3] * d[i];
    }
}

/// x ← M⁻¹ x for the degrees of freedom `dofs` (ascending, whole trees).
#[inline(never)]
pub fn solve(m: &Model, ld: &[f64], diag_inv: &[f64], x: &mut [f64], dofs: Range<usize>) {
    if is_diagonal(m, &dofs) {
        for (x, inv) in x[dofs.clone()].iter_mut().zip(&diag_inv[dofs]) {
            *x *= inv;
        }
        return;
    }
    if let Some(n) = whole_chain(m) {
        triangle::solve_rows(n, ld, diag_inv, x);
        return;
    }
    // The leading small chain of the tree, if it has one, is solved in one call between the backward and the forward
    // pass.
    let head = dofs.start + triangle::size_from(m, &dofs);
    for i in (head..dofs.end).rev() {
        let (values, columns) = below(m, ld, i);
        let xi = x[i];
        match consecutive(columns) {
            Some(range) if range.len() <= 3 => triangle::subtract_row(&mut x[range], values, xi),
            Some(range) => subtract(&mut x[range], values, xi),
            None => {
                for (l, &j) in values.iter().zip(columns) {
                    x[j as usize] -= l * xi;
                }
            }
        }
    }
    let first = m.M_rowadr[dofs.start] as usize;
    triangle::solve_rows(head - dofs.start, &ld[first..], &diag_inv[dofs.start..], &mut x[dofs.start..]);
    for i in head..dofs.end {
        let (values, columns) = below(m, ld, i);
        let mut s = x[i] * diag_inv[i];
        match consecutive(columns) {
            Some(range) if range.len() <= 3 => s = triangle::less_row(s, values, &x[range]),
            Some(range) => s -= dot_slice(values, &x[range]),
            None => {
                for (l, &j) in values.iter().zip(columns) {
                    s -= l * x[j as usize];
                }
            }
        }
        x[i] = s;
    }
}

/// The elements of row `i` left of the diagonal, and their columns.
#[cfg_attr(not(feature = "small"), inline(always))]
fn below<'a>(m: &'a Model, ld: &'a [f64], i: usize) -> (&'a [f64], &'a [i32]) {
    let start = m.M_rowadr[i] as usize;
    let end = start + m.M_rownnz[i] as usize - 1;
    (&ld[start..end], &m.M_colind[start..end])
}

/// The range of columns that are consecutive, as for a serial chain and the bodies that it carries.
#[cfg_attr(not(feature = "small"), inline(always))]
fn consecutive(columns: &[i32]) -> Option<Range<usize>> {
    let range = *columns.first()? as usize..*columns.last()? as usize + 1;
    (range.len() == columns.len()).then_some(range)
}

/// out ← M v for the degrees of freedom `dofs` (ascending, whole trees).
pub fn mul(m: &Model, mass: &[f64], v: &[f64], out: &mut [f64], dofs: Range<usize>) {
    if is_diagonal(m, &dofs) {
        let diagonal = &mass[rows_of(m, dofs.clone())];
        combine(&mut out[dofs.clone()], [diagonal, &v[dofs]], |_, [mass, v]| mass * v);
        return;
    }
    // Slices of equal length let the compiler remove bounds checks.
    let (v, out) = (&v[..dofs.end], &mut out[..dofs.end]);
    for i in dofs {
        let row = row(m, i);
        let Some((diagonal, before)) = mass[row.clone()].split_last() else {
            return broken_invariant("a row of M has its diagonal");
        };
        if before.is_empty() {
            out[i] = diagonal * v[i];
            continue;
        }
        let columns = &m.M_colind[row][..before.len()];
        let ((fours, rest), (by_four, columns)) = (before.as_chunks::<4>(), columns.as_chunks::<4>());
        let vi = v[i];
        let mut sum = diagonal * vi;
        // The upper triangle is added as well: the columns are ancestors of i, so their sums have been initialized
        // already.
        for (a, &j) in rest.iter().zip(columns) {
            sum += a * v[j as usize];
            out[j as usize] += a * vi;
        }
        if fours.is_empty() {
            out[i] = sum;
            continue;
        }
        let mut sums = f64x4::ZERO;
        for (a, j) in fours.iter().zip(by_four) {
            let (a, columns) = (f64x4::new(*a), j.map(|j| j as usize));
            let together = (!SMALL && j[3] - j[0] == 3).then_some(columns[0]);
            match together.and_then(|j| Some((v[j..].first_chunk()?, out[j..].first_chunk_mut()?))) {
                Some((v, out)) => {
                    sums += a * f64x4::new(*v);
                    *out = (f64x4::new(*out) + a * vi).to_array();
                }
                None => {
                    sums += a * f64x4::new(columns.map(|j| v[j]));
                    for (j, x) in columns.into_iter().zip((a * vi).to_array()) {
                        out[j] += x;
                    }
                }
            }
        }
        out[i] = sum + total(sums);
    }
}

/// The index of the diagonal element of degree of freedom `i`.
#[cfg_attr(not(feature = "small"), inline(always))]
pub(crate) fn diagonal(m: &Model, i: usize) -> usize {
    (m.M_rowadr[i] + m.M_rownnz[i]) as usize - 1
}

/// The dense 6×6 block of a free joint with the first degree of freedom `first`, from a matrix with the pattern of M.
pub(crate) fn free_block(m: &Model, mass: &[f64], first: usize) -> [Spatial; 6] {
    let mut out = [[0.0; 6]; 6];
    let dofs = first..first + 6;
    if is_diagonal(m, &dofs) {
        for (i, x) in mass[rows_of(m, dofs)].iter().take(6).enumerate() {
            out[i][i] = *x;
        }
        return out;
    }
    for r in 0..6 {
        let row = m.M_rowadr[first + r] as usize..diagonal(m, first + r) + 1;
        for (&k, &x) in m.M_colind[row.clone()].iter().zip(&mass[row]) {
            let c = k as usize - first;
            (out[r][c], out[c][r]) = (x, x);
        }
    }
    out
}

/// Adds s x xᵀ for a sparse vector x, at the entries of M only. `dofs` are ascending.
pub(crate) fn add_outer(m: &Model, dofs: &[i32], values: &[f64], s: f64, out: &mut [f64]) {
    for (&i, x) in dofs.iter().zip(values) {
        let start = m.M_rowadr[i as usize] as usize;
        let columns = &m.M_colind[start..diagonal(m, i as usize) + 1];
        // Both lists are in ascending order.
        let mut index = 0;
        for (&j, y) in dofs.iter().zip(values) {
            while index < columns.len() && columns[index] < j {
                index += 1;
            }
            if index < columns.len() && columns[index] == j {
                out[start + index] += s * x * y;
            }
        }
    }
}

/// Sum of the diagonal of M over the degrees of freedom `dofs`.
pub fn trace(m: &Model, mass: &[f64], dofs: Range<usize>) -> f64 {
    if m.nC == m.nv {
        return sum([&mass[dofs]], |[x]| x);
    }
    if is_diagonal(m, &dofs) {
        return mass[rows_of(m, dofs)].iter().sum();
    }
    dofs.map(|k| mass[diagonal(m, k)]).sum()
}

/// x ← D^-½ L⁻ᵀ x for a vector of nv numbers (`mj_solveM2`): half of the solution, so that the squared norm of the
/// result is xᵀ M⁻¹ x.
pub fn solve_m2(m: &Model, d: &Fields, x: &mut [f64]) {
    for i in (0..m.nv).rev() {
        let row = m.M_rowadr[i] as usize..diagonal(m, i);
        let xi = x[i];
        for (&j, l) in m.M_colind[row.clone()].iter().zip(&d.qLD[row]) {
            x[j as usize] -= l * xi;
        }
    }
    for (x, inv) in x.iter_mut().zip(&d.qLDiagInv) {
        *x *= inv.sqrt();
    }
}

/// M as a dense symmetric matrix, row-major (`mj_fullM`).
pub fn full_m(m: &Model, d: &Fields) -> Vec<f64> {
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
