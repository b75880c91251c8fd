//! The constraint rows of the current position: Jacobian, violation, regularization; and, once velocities
//! are known, the reference acceleration.
//!
//! Order: joint limits, then contacts. A row is a scalar `J a`; its regularization R makes it soft.

use super::impedance::{Kbi, kbi};
use super::kind;
use crate::jacobian::{self, Columns};
use crate::math::*;
use crate::{Contact, Data, Model, disable, joint};

/// `efc_*` up to R and D, `nefc`.
#[inline(never)]
pub(crate) fn make(m: &Model, d: &mut Data) {
    d.work.jac.clear();
    let on = |bit: i32| !m.opt.disabled(disable::CONSTRAINT) && !m.opt.disabled(bit);
    let limited =
        if d.plan.limits && on(disable::LIMIT) { m.jnt_limited.iter().filter(|&&l| l).count() } else { 0 };
    let touching: usize = d.contact.iter().map(|c| if c.dim == 1 { 1 } else { 4 }).sum();
    // Room for all that may come; the arrays keep their length from step to step as long as contacts stay.
    resize(d, 2 * limited + touching);
    d.nefc = 0;
    if limited > 0 {
        joint_limits(m, d);
    }
    contacts(m, d);
    resize(d, d.nefc);
}

fn resize(d: &mut Data, rows: usize) {
    if d.efc_type.len() == rows && d.efc_force.len() == rows {
        return;
    }
    d.efc_type.resize(rows, 0);
    d.efc_id.resize(rows, 0);
    d.efc_KBIP.resize(4 * rows, 0.0);
    let floats = [&mut d.efc_pos, &mut d.efc_margin, &mut d.efc_diagA, &mut d.efc_D, &mut d.efc_R];
    for v in floats.into_iter().chain([&mut d.efc_vel, &mut d.efc_aref, &mut d.efc_force]) {
        v.resize(rows, 0.0);
    }
}

/// What all rows of one constraint share.
struct Shared {
    kind: i32,
    id: usize,
    pos: f64,
    margin: f64,
    kbi: Kbi,
    r: f64,
}

/// Appends the scalars of the R rows of a constraint; the caller appends their Jacobian.
#[inline(always)]
fn push<const R: usize>(d: &mut Data, s: &Shared) {
    let Kbi { k, b, imp, slope } = s.kbi;
    let rows = d.nefc..d.nefc + R;
    d.nefc = rows.end;
    put(&mut d.efc_type[rows.clone()], [s.kind; R]);
    put(&mut d.efc_id[rows.clone()], [s.id as i32; R]);
    put(&mut d.efc_pos[rows.clone()], [s.pos; R]);
    put(&mut d.efc_margin[rows.clone()], [s.margin; R]);
    put(&mut rows_mut::<4>(&mut d.efc_KBIP)[rows.clone()], [[k, b, imp, slope]; R]);
    put(&mut d.efc_diagA[rows.clone()], [s.r * imp / (1.0 - imp); R]);
    put(&mut d.efc_R[rows.clone()], [s.r; R]);
    put(&mut d.efc_D[rows], [1.0 / s.r; R]);
}

#[inline(always)]
fn put<T, const R: usize>(to: &mut [T], values: [T; R]) {
    if let Some(to) = to.first_chunk_mut::<R>() {
        *to = values;
    }
}

/// R = (1 - d)/d A, so that the constraint acts with the fraction d of the force that would hold it rigid.
#[inline]
fn regularization(imp: f64, diag: f64) -> f64 {
    ((1.0 - imp) / imp * diag).max(MINVAL)
}

/// One row for each violated side of a hinge or slide limit, lower side first; one for a ball's cone.
fn joint_limits(m: &Model, d: &mut Data) {
    for j in 0..m.njnt {
        if !m.jnt_limited[j] {
            continue;
        }
        let range = rows::<2>(&m.jnt_range)[j];
        let q = m.jnt_qposadr[j] as usize;
        let margin = m.jnt_margin[j];
        match m.jnt_type[j] {
            joint::SLIDE | joint::HINGE => {
                for (side, sign) in [(range[0], 1.0), (range[1], -1.0)] {
                    let dist = sign * (d.qpos[q] - side);
                    if dist < margin {
                        limit_row(m, d, j, dist, &[sign]);
                    }
                }
            }
            joint::BALL => {
                let turn =
                    quat_to_vel(quat_normalize([d.qpos[q], d.qpos[q + 1], d.qpos[q + 2], d.qpos[q + 3]]));
                let (axis, angle) = normalize(turn);
                let dist = range[0].max(range[1]) - angle;
                if dist < margin {
                    limit_row(m, d, j, dist, &scale(axis, -1.0));
                }
            }
            _ => {}
        }
    }
}

fn limit_row(m: &Model, d: &mut Data, j: usize, dist: f64, jac: &[f64]) {
    let (dof, margin) = (m.jnt_dofadr[j] as usize, m.jnt_margin[j]);
    let (n, last) = (jac.len(), dof + jac.len() - 1);
    let columns: [u32; 3] = std::array::from_fn(|c| last.saturating_sub(c) as u32);
    d.work.jac.push::<1>(d.nefc, &columns[..n], jac.iter().rev().map(|&j| [j]));
    let kbi = kbi(m, rows::<2>(&m.jnt_solref)[j], rows::<5>(&m.jnt_solimp)[j], dist - margin);
    let r = regularization(kbi.imp, m.dof_invweight0[dof]);
    push::<1>(d, &Shared { kind: kind::LIMIT_JOINT, id: j, pos: dist, margin, kbi, r });
}

/// One row along the normal for a frictionless contact; otherwise the edges n ± μ t of the pyramid.
fn contacts(m: &Model, d: &mut Data) {
    let mut list = std::mem::take(&mut d.contact);
    let mut columns = std::mem::take(&mut d.work.columns);
    for (id, c) in list.iter_mut().enumerate() {
        c.efc_address = None;
        if c.exclude != 0 {
            continue;
        }
        let (b1, b2) = (m.geom_bodyid[c.geom1] as usize, m.geom_bodyid[c.geom2] as usize);
        jacobian::point_difference(m, d, [b1, b2], c.pos, &c.frame, &mut columns);
        if columns.dofs().is_empty() {
            c.exclude = 3;
            continue;
        }
        c.efc_address = Some(d.nefc);
        let translation = m.body_invweight0[2 * b1] + m.body_invweight0[2 * b2];
        contact_rows(m, d, id, c, translation, &columns);
    }
    d.contact = list;
    d.work.columns = columns;
}

#[inline(always)]
fn contact_rows(m: &Model, d: &mut Data, id: usize, c: &mut Contact, translation: f64, columns: &Columns) {
    let (cols, along) = (columns.dofs(), columns.values());
    let (row, mu, mu2) = (d.nefc, c.friction[0], c.friction[1]);
    let kbi = kbi(m, c.solref, c.solimp, c.dist - c.includemargin);
    let shared = |kind: i32, r: f64| Shared { kind, id, pos: c.dist, margin: c.includemargin, kbi, r };
    if c.dim == 1 {
        d.work.jac.push::<1>(row, cols, along.iter().map(|a| [a[0]]));
        push::<1>(d, &shared(kind::CONTACT_FRICTIONLESS, regularization(kbi.imp, translation)));
        return;
    }
    let edges = |&[n, t1, t2]: &Vec3| [n + mu * t1, n - mu * t1, n + mu2 * t2, n - mu2 * t2];
    d.work.jac.push::<4>(row, cols, along.iter().map(edges));
    // Every edge is as soft as the friction cone is: R = 2 μ² R(edge 0), with μ = μ1 / √impratio.
    let r0 = regularization(kbi.imp, translation + mu * mu * translation);
    let mu_reg = mu * (1.0 / m.opt.impratio.max(MINVAL)).sqrt();
    push::<4>(d, &shared(kind::CONTACT_PYRAMIDAL, (2.0 * mu_reg * mu_reg * r0).max(MINVAL)));
    c.mu = mu_reg;
}

/// `efc_vel` = J v and `efc_aref` = -B J v - K d r: the acceleration of a damped spring on the violation.
#[inline(never)]
pub(crate) fn reference(d: &mut Data) {
    d.work.jac.mul(&d.qvel, &mut d.efc_vel);
    let rows = d.efc_pos.iter().zip(&d.efc_margin).zip(rows::<4>(&d.efc_KBIP)).zip(&d.efc_vel);
    for (aref, (((pos, margin), [k, b, imp, _]), vel)) in d.efc_aref.iter_mut().zip(rows) {
        *aref = -b * vel - k * imp * (pos - margin);
    }
}
