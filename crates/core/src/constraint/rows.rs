//! The constraint rows of the current position: Jacobian, violation, regularization; and, once velocities
//! are known, the reference acceleration.
//!
//! Order: joint limits, then contacts. A row is a scalar `J a`; its regularization R makes it soft.

use super::impedance::{Kbi, kbi};
use super::kind;
use crate::math::*;
use crate::{Contact, Data, Model, disable, jacobian, joint};

/// `efc_*` up to R and D, `nefc`.
#[inline(never)]
pub(crate) fn make(m: &Model, d: &mut Data) {
    clear(d);
    if !m.opt.disabled(disable::CONSTRAINT) {
        if !m.opt.disabled(disable::LIMIT) {
            joint_limits(m, d);
        }
        contacts(m, d);
    }
    d.nefc = d.efc_type.len();
    d.efc_vel.resize(d.nefc, 0.0);
    d.efc_aref.resize(d.nefc, 0.0);
    d.efc_force.resize(d.nefc, 0.0);
}

fn clear(d: &mut Data) {
    d.efc_type.clear();
    d.efc_id.clear();
    d.efc_pos.clear();
    d.efc_margin.clear();
    d.efc_diagA.clear();
    d.efc_KBIP.clear();
    d.efc_D.clear();
    d.efc_R.clear();
    d.work.jac.clear();
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
    d.efc_type.extend_from_slice(&[s.kind; R]);
    d.efc_id.extend_from_slice(&[s.id as i32; R]);
    d.efc_pos.extend_from_slice(&[s.pos; R]);
    d.efc_margin.extend_from_slice(&[s.margin; R]);
    d.efc_KBIP.extend_from_slice([[k, b, imp, slope]; R].as_flattened());
    d.efc_diagA.extend_from_slice(&[s.r * imp / (1.0 - imp); R]);
    d.efc_R.extend_from_slice(&[s.r; R]);
    d.efc_D.extend_from_slice(&[1.0 / s.r; R]);
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
                let turn = quat_to_vel(quat_normalize([d.qpos[q], d.qpos[q + 1], d.qpos[q + 2], d.qpos[q + 3]]));
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
    d.work.jac.push::<1>(d.efc_type.len(), &columns[..n], |c| [jac[n - 1 - c]]);
    let kbi = kbi(m, rows::<2>(&m.jnt_solref)[j], rows::<5>(&m.jnt_solimp)[j], dist - margin);
    let r = regularization(kbi.imp, m.dof_invweight0[dof]);
    push::<1>(d, &Shared { kind: kind::LIMIT_JOINT, id: j, pos: dist, margin, kbi, r });
}

/// One row along the normal for a frictionless contact; otherwise the edges n ± μ t of the pyramid.
fn contacts(m: &Model, d: &mut Data) {
    let mut list = std::mem::take(&mut d.contact);
    let mut cols = std::mem::take(&mut d.work.cols);
    let mut along = std::mem::take(&mut d.work.along);
    for (id, c) in list.iter_mut().enumerate() {
        c.efc_address = None;
        if c.exclude != 0 {
            continue;
        }
        let (b1, b2) = (m.geom_bodyid[c.geom1] as usize, m.geom_bodyid[c.geom2] as usize);
        jacobian::point_difference(m, d, [b1, b2], c.pos, &c.frame, &mut cols, &mut along);
        if cols.is_empty() {
            c.exclude = 3;
            continue;
        }
        c.efc_address = Some(d.efc_type.len());
        let translation = m.body_invweight0[2 * b1] + m.body_invweight0[2 * b2];
        contact_rows(m, d, id, c, translation, &cols, &along);
    }
    d.contact = list;
    d.work.cols = cols;
    d.work.along = along;
}

#[inline(always)]
fn contact_rows(m: &Model, d: &mut Data, id: usize, c: &mut Contact, translation: f64, cols: &[u32], along: &[Vec3]) {
    let (row, mu, mu2) = (d.efc_type.len(), c.friction[0], c.friction[1]);
    let kbi = kbi(m, c.solref, c.solimp, c.dist - c.includemargin);
    let shared = |kind: i32, r: f64| Shared { kind, id, pos: c.dist, margin: c.includemargin, kbi, r };
    if c.dim == 1 {
        d.work.jac.push::<1>(row, cols, |k| [along[k][0]]);
        push::<1>(d, &shared(kind::CONTACT_FRICTIONLESS, regularization(kbi.imp, translation)));
        c.mu = mu;
        return;
    }
    d.work.jac.push::<4>(row, cols, |k| {
        let [n, t1, t2] = along[k];
        [n + mu * t1, n - mu * t1, n + mu2 * t2, n - mu2 * t2]
    });
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
