//! Constraints with a single row: dry friction and limits of joints and tendons.

use super::cost::Cost;
use super::equality_rows;
use super::impedance::{Acts, kbi};
use super::jacobian::ConstraintJacobian;
use super::kind;
use super::rows::{ConstraintRows, push, regularization};
use crate::forces::tendon;
use crate::kinds::{eqtype, joint};
use crate::math::*;
use crate::model::{Fields, Model, asleep};

/// Number of dry friction rows.
pub(super) fn count_friction(m: &Model) -> usize {
    let some = |list: &[f64]| list.iter().filter(|&&f| f > 0.0).count();
    some(&m.dof_frictionloss) + some(&m.tendon_frictionloss)
}

/// Upper limit of the number of limit rows of joints and tendons. A coordinate within its range needs none.
pub(super) fn count_limits(m: &Model, d: &Fields) -> usize {
    let joints = m.jnt_limited.iter().zip(&m.jnt_type).zip(&m.jnt_qposadr);
    let joints = joints.zip(rows::<2>(&m.jnt_range).iter().zip(&m.jnt_margin));
    let mut count = 0;
    for (((&limited, &kind), &q), (range, &margin)) in joints {
        count += match kind {
            _ if !limited => 0,
            joint::SLIDE | joint::HINGE => near(*range, d.qpos[q as usize], margin),
            _ => 1,
        };
    }
    if m.ntendon == 0 {
        return count;
    }
    let tendons = m.tendon_limited.iter().zip(&d.ten_length).zip(&m.tendon_margin);
    for (((&limited, &length), &margin), range) in tendons.zip(rows::<2>(&m.tendon_range)) {
        count += if limited { near(*range, length, margin) } else { 0 };
    }
    count
}

/// The number of sides of a range whose distance is below the margin: see [`sides`].
#[cfg_attr(not(feature = "small"), inline(always))]
fn near([lower, upper]: [f64; 2], value: f64, margin: f64) -> usize {
    usize::from(value - lower < margin) + usize::from(upper - value < margin)
}

/// The scalar quantities of a row: `efc_type`, `efc_id`, violation, margin, and the largest force of dry friction.
#[derive(Clone, Copy)]
struct RowScalars {
    kind: i32,
    id: usize,
    pos: f64,
    margin: f64,
    loss: f64,
}

/// Appends the scalar quantities of a row, after its Jacobian.
fn scalars(m: &Model, d: &mut Fields, row: RowScalars, solref: [f64; 2], solimp: [f64; 5], weight: f64) {
    let RowScalars { kind, id, pos, margin, loss } = row;
    let dry = Cost::for_row(kind) == Cost::DryFriction;
    let acts = if dry { Acts::BothWays } else { Acts::OneWay };
    let mut kbi = kbi(m, acts, solref, solimp, pos - margin);
    if dry {
        kbi.k = 0.0;
    }
    let r = [regularization(kbi.imp, weight)];
    push::<1>(d, &ConstraintRows { kind, id, pos: [pos], margin: [margin], loss, kbi, others: kbi, r });
}

/// Creates a row for each degree of freedom and each tendon with dry friction.
pub(super) fn friction(m: &Model, d: &mut Fields, jac: &mut ConstraintJacobian) {
    for k in 0..m.nv {
        let loss = m.dof_frictionloss[k];
        if loss > 0.0 && !asleep::body(m, d, m.dof_bodyid[k] as usize) {
            jac.push::<1>(Cost::DryFriction, d.nefc, &[k as u32], [[1.0]].into_iter());
            let row = RowScalars { kind: kind::FRICTION_DOF, id: k, pos: 0.0, margin: 0.0, loss };
            let (solref, solimp) = (rows::<2>(&m.dof_solref)[k], rows::<5>(&m.dof_solimp)[k]);
            scalars(m, d, row, solref, solimp, m.dof_invweight0[k]);
        }
    }
    for t in 0..m.ntendon {
        let loss = m.tendon_frictionloss[t];
        if loss > 0.0 && !asleep::tendon(m, d, t) && along_tendon(m, d, jac, Cost::DryFriction, t, 1.0) {
            let row = RowScalars { kind: kind::FRICTION_TENDON, id: t, pos: 0.0, margin: 0.0, loss };
            let (solref, solimp) = (rows::<2>(&m.tendon_solref_fri)[t], rows::<5>(&m.tendon_solimp_fri)[t]);
            scalars(m, d, row, solref, solimp, m.tendon_invweight0[t]);
        }
    }
}

/// Creates a row for each violated side of a limit, the lower side first, and a single row for the angle of a ball
/// joint.
pub(super) fn limits(m: &Model, d: &mut Fields, jac: &mut ConstraintJacobian) {
    for j in 0..m.njnt {
        if !m.jnt_limited[j] || asleep::body(m, d, m.jnt_bodyid[j] as usize) {
            continue;
        }
        let range = rows::<2>(&m.jnt_range)[j];
        let q = m.jnt_qposadr[j] as usize;
        match m.jnt_type[j] {
            joint::SLIDE | joint::HINGE => {
                let value = d.qpos[q];
                for (dist, sign) in sides(range, value, m.jnt_margin[j]) {
                    joint_limit(m, d, jac, j, dist, &[sign]);
                }
            }
            joint::BALL => {
                let turn =
                    quat_to_vel(quat_normalize([d.qpos[q], d.qpos[q + 1], d.qpos[q + 2], d.qpos[q + 3]]));
                let (axis, angle) = normalize(turn);
                let dist = range[0].max(range[1]) - angle;
                if dist < m.jnt_margin[j] {
                    joint_limit(m, d, jac, j, dist, &scale(axis, -1.0));
                }
            }
            _ => {}
        }
    }
    for t in 0..m.ntendon {
        if !m.tendon_limited[t] || asleep::tendon(m, d, t) {
            continue;
        }
        let margin = m.tendon_margin[t];
        for (pos, sign) in sides(rows::<2>(&m.tendon_range)[t], d.ten_length[t], margin) {
            if along_tendon(m, d, jac, Cost::Unilateral, t, sign) {
                let row = RowScalars { kind: kind::LIMIT_TENDON, id: t, pos, margin, loss: 0.0 };
                let (solref, solimp) =
                    (rows::<2>(&m.tendon_solref_lim)[t], rows::<5>(&m.tendon_solimp_lim)[t]);
                scalars(m, d, row, solref, solimp, m.tendon_invweight0[t]);
            }
        }
    }
}

/// The sides of a range whose distance is below the margin: distance, and the sign of the direction away from the
/// side.
fn sides(range: [f64; 2], value: f64, margin: f64) -> impl Iterator<Item = (f64, f64)> {
    let both = [(range[0], 1.0), (range[1], -1.0)];
    both.into_iter().map(move |(side, sign)| (sign * (value - side), sign)).filter(move |s| s.0 < margin)
}

fn joint_limit(m: &Model, d: &mut Fields, jac: &mut ConstraintJacobian, j: usize, pos: f64, row: &[f64]) {
    let dof = m.jnt_dofadr[j] as usize;
    let (n, last) = (row.len(), dof + row.len() - 1);
    let columns: [u32; 3] = std::array::from_fn(|c| last.saturating_sub(c) as u32);
    jac.push::<1>(Cost::Unilateral, d.nefc, &columns[..n], row.iter().rev().map(|&j| [j]));
    let row = RowScalars { kind: kind::LIMIT_JOINT, id: j, pos, margin: m.jnt_margin[j], loss: 0.0 };
    let (solref, solimp) = (rows::<2>(&m.jnt_solref)[j], rows::<5>(&m.jnt_solimp)[j]);
    scalars(m, d, row, solref, solimp, m.dof_invweight0[dof]);
}

/// Appends the Jacobian of the length of a tendon, times `sign`. Returns `false` if nothing moves the tendon.
fn along_tendon(
    m: &Model,
    d: &Fields,
    jac: &mut ConstraintJacobian,
    cost: Cost,
    t: usize,
    sign: f64,
) -> bool {
    let row = tendon::row(m, t);
    let values = d.ten_J[row.clone()].iter().map(|j| sign * j);
    jac.push_sparse(cost, d.nefc, &m.ten_J_colind[row], values);
    jac.keep_if_moving(m)
}

/// The force of all constraints along a tendon, N.
pub(crate) fn tendon_force(m: &Model, d: &Fields, t: usize) -> f64 {
    let range = sides(rows::<2>(&m.tendon_range)[t], d.ten_length[t], m.tendon_margin[t]);
    let mut signs = range.map(|(_, sign)| sign);
    let mut sum = 0.0;
    for row in 0..d.ne + d.nf + d.nl {
        let (id, force) = (d.efc_id[row] as usize, d.efc_force[row]);
        match d.efc_type[row] {
            kind::EQUALITY if m.eq_type.get(id) == Some(&eqtype::TENDON) => {
                let tied = [m.eq_obj1id[id], m.eq_obj2id[id]].map(|o| o == t as i32);
                sum += if tied[0] { force } else { 0.0 };
                sum += if tied[1] { force * equality_rows::ratio(m, d, id) } else { 0.0 };
            }
            kind::FRICTION_TENDON if id == t => sum += force,
            // If the range was written after the rows were created, a row without a matching side counts as one of
            // the lower side.
            kind::LIMIT_TENDON if id == t => sum += force * signs.next().unwrap_or(1.0),
            _ => {}
        }
    }
    sum
}
