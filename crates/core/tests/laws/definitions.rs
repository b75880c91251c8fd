//! Quantities computed independently from their definitions, with dense matrices, and random states.

use labspec_core::{self as core, Data, Model, joint};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use proptest::collection::vec;
use proptest::prelude::*;

pub(crate) fn vector(a: &[f64], i: usize) -> Vector3<f64> {
    Vector3::from_column_slice(&a[3 * i..3 * i + 3])
}

pub(crate) fn matrix(a: &[f64], i: usize) -> Matrix3<f64> {
    Matrix3::from_row_slice(&a[9 * i..9 * i + 9])
}

/// The Jacobians of a body's centre of mass and of its orientation, 3 × nv each, computed joint by joint from the definition.
pub(crate) fn jacobian(m: &Model, d: &Data, body: usize) -> (DMatrix<f64>, DMatrix<f64>) {
    let (mut move_, mut turn) = (DMatrix::zeros(3, m.nv), DMatrix::zeros(3, m.nv));
    let point = vector(&d.xipos, body);
    let mut b = body;
    while b > 0 {
        for j in (0..m.njnt).filter(|&j| m.jnt_bodyid[j] as usize == b) {
            let dof = m.jnt_dofadr[j] as usize;
            let mut rotation = |k: usize, axis: Vector3<f64>| {
                turn.set_column(k, &axis);
                move_.set_column(k, &axis.cross(&(point - vector(&d.xanchor, j))));
            };
            match m.jnt_type[j] {
                joint::HINGE => rotation(dof, vector(&d.xaxis, j)),
                joint::SLIDE => move_.set_column(dof, &vector(&d.xaxis, j)),
                kind => {
                    // The rotations of ball and free joints are about the body's own axes.
                    let first = if kind == joint::FREE { dof + 3 } else { dof };
                    (0..3).for_each(|k| rotation(first + k, matrix(&d.xmat, b).column(k).into()));
                    if kind == joint::FREE {
                        (0..3).for_each(|k| move_[(k, dof + k)] = 1.0);
                    }
                }
            }
        }
        b = m.body_parentid[b] as usize;
    }
    (move_, turn)
}

/// Inertia of a body about its centre of mass, world axes.
pub(crate) fn inertia(m: &Model, d: &Data, body: usize) -> Matrix3<f64> {
    let axes = matrix(&d.ximat, body);
    axes * Matrix3::from_diagonal(&vector(&m.body_inertia, body)) * axes.transpose()
}

/// Σ m Jᵀ J + Jᵀ I J over all bodies, plus the armature.
pub(crate) fn mass_matrix(m: &Model, d: &Data) -> DMatrix<f64> {
    let mut all = DMatrix::from_diagonal(&DVector::from_column_slice(&m.dof_armature));
    for b in 1..m.nbody {
        let (move_, turn) = jacobian(m, d, b);
        all += m.body_mass[b] * move_.tr_mul(&move_) + turn.tr_mul(&(inertia(m, d, b) * &turn));
    }
    all
}

/// The total momentum: linear, and angular about the origin.
pub(crate) fn momentum(m: &Model, d: &Data) -> [f64; 6] {
    let v = DVector::from_column_slice(&d.qvel);
    let (mut linear, mut angular) = (Vector3::zeros(), Vector3::zeros());
    for b in 1..m.nbody {
        let (move_, turn) = jacobian(m, d, b);
        let p: Vector3<f64> = Vector3::from_iterator((&move_ * &v * m.body_mass[b]).iter().copied());
        let spin = inertia(m, d, b) * Vector3::from_iterator((&turn * &v).iter().copied());
        linear += p;
        angular += spin + vector(&d.xipos, b).cross(&p);
    }
    [linear.x, linear.y, linear.z, angular.x, angular.y, angular.z]
}

/// Sets a random configuration with random velocities.
pub(crate) fn scatter(m: &Model, d: &mut Data, numbers: &[f64]) {
    let take = |from: usize| (0..m.nv).map(|i| numbers[(from + i) % numbers.len()]).collect::<Vec<_>>();
    core::integrate_pos(m, d.edit().qpos, &take(0), 0.5).unwrap();
    d.edit().qvel.copy_from_slice(&take(m.nv));
}

pub(crate) fn numbers() -> impl Strategy<Value = Vec<f64>> {
    vec(-1.0..1.0, 61)
}

pub(crate) fn full_m(m: &Model, d: &Data) -> DMatrix<f64> {
    DMatrix::from_row_slice(m.nv, m.nv, &core::full_m(m, d).unwrap())
}

/// Rounding errors: sums of some hundred products, of which the largest cancel at most in the third digit.
pub(crate) const ROUNDING: f64 = 1e-12;
