//! The mass matrix with its products, and the Jacobian of the constraints.

use super::{Data, Error, Model, Scope, check_length};
use crate::constraint;
use crate::dynamics::mass;
use crate::model::reflect::data;
use crate::step;

/// The Jacobian of the constraints as a dense matrix, `nefc` x `nv`, row-major (`efc_J`).
pub fn full_j<S: Scope>(m: &Model, d: &Data<S>) -> Result<Vec<f64>, Error> {
    d.belongs_to(m)?;
    d.has(&[data::efc_force])?;
    Ok(constraint::full_j(m, &d.fields, &d.scratch.constraint.jac))
}

/// M as a dense symmetric matrix, `nv` x `nv`, row-major (`mj_fullM`).
pub fn full_m<S: Scope>(m: &Model, d: &Data<S>) -> Result<Vec<f64>, Error> {
    d.belongs_to(m)?;
    d.has(&[data::M])?;
    Ok(mass::full_m(m, &d.fields))
}

/// out ← M v (`mj_mulM`), for vectors of nv numbers.
pub fn mul_m<S: Scope>(m: &Model, d: &Data<S>, v: &[f64], out: &mut [f64]) -> Result<(), Error> {
    d.belongs_to(m)?;
    d.has(&[data::M])?;
    check_length("the vector", m.nv, v.len())?;
    check_length("the product", m.nv, out.len())?;
    mass::mul(m, &d.fields.M, v, out, 0..m.nv);
    Ok(())
}

/// x ← M⁻¹ x (`mj_solveM`), for a vector of nv numbers.
pub fn solve_m<S: Scope>(m: &Model, d: &Data<S>, x: &mut [f64]) -> Result<(), Error> {
    d.belongs_to(m)?;
    d.has(&[data::qLD, data::qLDiagInv])?;
    check_length("the vector", m.nv, x.len())?;
    mass::solve(m, &d.fields.qLD, &d.fields.qLDiagInv, x, 0..m.nv);
    Ok(())
}

/// x ← D^-½ L⁻ᵀ x (`mj_solveM2`), for a vector of nv numbers. The squared norm of the result is xᵀ M⁻¹ x.
pub fn solve_m2<S: Scope>(m: &Model, d: &Data<S>, x: &mut [f64]) -> Result<(), Error> {
    d.belongs_to(m)?;
    d.has(&[data::qLD, data::qLDiagInv])?;
    check_length("the vector", m.nv, x.len())?;
    mass::solve_m2(m, &d.fields, x);
    Ok(())
}

/// Computes `M` for the body poses that the data contain, for example after [`mechanical_energy`](super::mechanical_energy).
///
/// # Errors
///
/// When the data belongs to another model, or its plan leaves out `M` or inertias of bodies.
pub fn mass_matrix<S: Scope>(m: &Model, d: &mut Data<S>) -> Result<(), Error> {
    d.has(&[data::cinert, data::M])?;
    let (d, s) = d.engine(m)?;
    step::forward::mass_matrix(m, d, s);
    Ok(())
}
