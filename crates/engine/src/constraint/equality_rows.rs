//! The rows of equality constraints, and the velocity-dependent part of their acceleration.
//!
//! A connect constrains two points, a weld two frames: x₁ - x₂ = 0 and Im(q₂⁻¹ q₁) = 0, whose rate is ½ Im(q₂⁻¹ (ω₁ -
//! ω₂) q₁). One joint or tendon follows a polynomial of another (MuJoCo's documentation, "Computation: Constraint
//! model, Equality").

use super::ConstraintScratch;
use super::cost::Cost;
use super::ends::{self, ConstraintEnd};
use super::impedance::{Acts, kbi};
use super::jacobian::ConstraintJacobian;
use super::kind;
use super::rows::{ConstraintRows, inverse_weight, push, regularization};
use crate::dynamics::jacobian::{self, Columns};
use crate::forces::tendon;
use crate::kinds::eqtype;
use crate::math::*;
use crate::model::index::object_index;
use crate::model::{Fields, Model, asleep};

/// Number of rows of the active constraints.
pub(super) fn count(m: &Model, d: &Fields) -> usize {
    (0..m.neq).filter(|&e| d.eq_active[e]).map(|e| ends::rows_of(m, e)).sum()
}

/// Creates the rows of all active constraints, ordered by id.
pub(super) fn make(m: &Model, d: &mut Fields, w: &mut ConstraintScratch) {
    let ConstraintScratch { jac, columns, .. } = w;
    for e in 0..m.neq {
        if !d.eq_active[e] || asleep::equality(m, d, e) {
            continue;
        }
        match (m.eq_type[e], ends::ends(m, d, e)) {
            (eqtype::CONNECT, Some(ends)) => connect(m, d, jac, e, &ends, columns),
            (eqtype::WELD, Some(ends)) => weld(m, d, jac, e, &ends, columns),
            (eqtype::JOINT, _) => coupled_joints(m, d, jac, e),
            (eqtype::TENDON, _) => coupled_tendons(m, d, jac, e),
            _ => {}
        }
    }
}

/// Appends the scalar quantities of a constraint. Its impedance is that of the violation `off`.
fn scalars<const R: usize>(m: &Model, d: &mut Fields, e: usize, pos: [f64; R], off: f64, weight: [f64; R]) {
    let kbi = kbi(m, Acts::BothWays, rows::<2>(&m.eq_solref)[e], rows::<5>(&m.eq_solimp)[e], off);
    let r = weight.map(|w| regularization(kbi.imp, w));
    push::<R>(
        d,
        &ConstraintRows {
            kind: kind::EQUALITY,
            id: e,
            pos,
            margin: [0.0; R],
            loss: 0.0,
            kbi,
            others: kbi,
            r,
        },
    );
}

fn difference(m: &Model, d: &Fields, ends: &[ConstraintEnd; 2], out: &mut Columns) {
    jacobian::pair_difference(m, d, [ends[0].body, ends[1].body], [ends[0].point, ends[1].point], out);
}

fn connect(
    m: &Model,
    d: &mut Fields,
    jac: &mut ConstraintJacobian,
    e: usize,
    ends: &[ConstraintEnd; 2],
    columns: &mut Columns,
) {
    difference(m, d, ends, columns);
    jac.push::<3>(Cost::Quadratic, d.nefc, columns.dofs(), columns.values().iter().copied());
    if jac.keep_if_moving(m) {
        let pos = sub(ends[0].point, ends[1].point);
        scalars(m, d, e, pos, norm(pos), [inverse_weight(m, [ends[0].body, ends[1].body], 0); 3]);
    }
}

fn weld(
    m: &Model,
    d: &mut Fields,
    jac: &mut ConstraintJacobian,
    e: usize,
    ends: &[ConstraintEnd; 2],
    columns: &mut Columns,
) {
    difference(m, d, ends, columns);
    let torquescale = rows::<11>(&m.eq_data)[e][10];
    let both = columns.values().iter().zip(columns.angular_part()).map(|(&[x, y, z], &turn)| {
        let [a, b, c] = scale(relative_rotation_rate(ends, turn), 0.5 * torquescale);
        [x, y, z, a, b, c]
    });
    jac.push::<6>(Cost::Quadratic, d.nefc, columns.dofs(), both);
    if jac.keep_if_moving(m) {
        let [x, y, z] = sub(ends[0].point, ends[1].point);
        let [_, a, b, c] = quat_mul(quat_conj(ends[1].quat), ends[0].quat);
        let [a, b, c] = scale([a, b, c], torquescale);
        let off = dot_slice(&[x, y, z, a, b, c], &[x, y, z, a, b, c]).sqrt();
        let [t, r] = [
            inverse_weight(m, [ends[0].body, ends[1].body], 0),
            inverse_weight(m, [ends[0].body, ends[1].body], 1),
        ];
        scalars(m, d, e, [x, y, z, a, b, c], off, [t, t, t, r, r, r]);
    }
}

/// Im(q₂⁻¹ w q₁)
fn relative_rotation_rate(ends: &[ConstraintEnd; 2], [x, y, z]: Vec3) -> Vec3 {
    let [_, a, b, c] = quat_mul(quat_mul(quat_conj(ends[1].quat), [0.0, x, y, z]), ends[0].quat);
    [a, b, c]
}

/// A polynomial and its derivative.
fn polynomial(coefficients: &[f64], x: f64) -> (f64, f64) {
    coefficients.iter().rev().fold((0.0, 0.0), |(value, slope), c| (value * x + c, slope * x + value))
}

/// Force on the second tendon of a tendon equality per unit force on the first.
pub(super) fn ratio(m: &Model, d: &Fields, e: usize) -> f64 {
    let second = usize::try_from(m.eq_obj2id[e]).ok();
    coupled(m, e, 0.0, second.map(|t| d.ten_length[t] - m.tendon_length0[t])).1
}

/// The constraint is q₁ - ref₁ = c(q₂ - ref₂), or = c₀ without a second object. Returns the violation, and its
/// derivative with respect to the second coordinate.
fn coupled(m: &Model, e: usize, first: f64, second: Option<f64>) -> (f64, f64) {
    let data = &rows::<11>(&m.eq_data)[e];
    match second {
        Some(x) => {
            let (value, slope) = polynomial(&data[..5], x);
            (first - value, -slope)
        }
        None => (first - data[0], 0.0),
    }
}

fn coupled_joints(m: &Model, d: &mut Fields, jac: &mut ConstraintJacobian, e: usize) {
    let first = object_index(m.eq_obj1id[e]);
    let second = usize::try_from(m.eq_obj2id[e]).ok();
    let moved = |j: usize| {
        let q = m.jnt_qposadr[j] as usize;
        d.qpos[q] - m.qpos0[q]
    };
    let (pos, ratio) = coupled(m, e, moved(first), second.map(moved));
    let mut weight = m.dof_invweight0[m.jnt_dofadr[first] as usize];
    let dof = |j: usize| &m.jnt_dofadr[j..j + 1];
    let other = second.map_or(&[][..], dof);
    jac.push_sum(Cost::Quadratic, d.nefc, (dof(first), &[1.0]), (other, &[1.0]), ratio);
    if let Some(&k) = other.first() {
        weight += m.dof_invweight0[k as usize];
    }
    if jac.keep_if_moving(m) {
        scalars(m, d, e, [pos], pos, [weight]);
    }
}

fn coupled_tendons(m: &Model, d: &mut Fields, jac: &mut ConstraintJacobian, e: usize) {
    let first = object_index(m.eq_obj1id[e]);
    let second = usize::try_from(m.eq_obj2id[e]).ok();
    let moved = |t: usize| d.ten_length[t] - m.tendon_length0[t];
    let (pos, ratio) = coupled(m, e, moved(first), second.map(moved));
    let along = |t: usize| (&m.ten_J_colind[tendon::row(m, t)], &d.ten_J[tendon::row(m, t)]);
    let other = second.map_or((&[][..], &[][..]), along);
    jac.push_sum(Cost::Quadratic, d.nefc, along(first), other, ratio);
    let weight = m.tendon_invweight0[first] + second.map_or(0.0, |t| m.tendon_invweight0[t]);
    if jac.keep_if_moving(m) {
        scalars(m, d, e, [pos], pos, [weight]);
    }
}

/// aref -= J̇ v for connects and welds.
pub(super) fn bias(m: &Model, d: &mut Fields) {
    let mut row = 0;
    while row < d.ne {
        let e = d.efc_id[row] as usize;
        if let Some(ends) = ends::ends(m, d, e) {
            let [a, b] = [0, 1].map(|i| jacobian::unforced(m, d, ends[i].body, ends[i].point));
            for (aref, x) in d.efc_aref[row..].iter_mut().zip(sub(a.acceleration, b.acceleration)) {
                *aref -= x;
            }
            if m.eq_type[e] == eqtype::WELD {
                // d/dt of ½ Im(q₂⁻¹ (ω₁ - ω₂) q₁) at zero joint accelerations, where q̇ = ½ ω q.
                let spin = sub(a.spin, b.spin);
                let torquescale = rows::<11>(&m.eq_data)[e][10];
                let quat = |v: Vec3| [0.0, v[0], v[1], v[2]];
                let product = sub(quat_mul(quat(spin), quat(a.spin)), quat_mul(quat(b.spin), quat(spin)));
                let inner = add_scaled(quat(sub(a.turn, b.turn)), product, 0.5);
                let turned = quat_mul(quat_mul(quat_conj(ends[1].quat), inner), ends[0].quat);
                for (aref, x) in d.efc_aref[row + 3..].iter_mut().zip(&turned[1..]) {
                    *aref -= 0.5 * torquescale * x;
                }
            }
        }
        row += ends::rows_of(m, e);
    }
}
