//! Jacobians and the mass matrix as dense matrices.

use crate::api::call;
use crate::api::data::{Data, Scope};
use crate::api::error::Error;
use crate::api::model::{BodyId, GeomId, Model, SiteId};
use crate::api::view::ObjectKey;
use nalgebra::{DMatrix, DVector, Point3};

/// The velocity of a point, and of the object that it is fixed to, for a unit velocity of each degree of freedom.
#[derive(Clone, Debug, PartialEq)]
pub struct PointJacobian {
    /// 3 × nv: velocity of the point, m/s, world axes.
    pub translation: DMatrix<f64>,
    /// 3 × nv: angular velocity of the object, rad/s, world axes.
    pub rotation: DMatrix<f64>,
}

impl PointJacobian {
    fn from_rows(m: &Model, jacobian: &call::Jacobian) -> PointJacobian {
        let matrix = |rows: &[f64]| DMatrix::from_row_slice(3, m.nv, rows);
        PointJacobian { translation: matrix(&jacobian.jacp), rotation: matrix(&jacobian.jacr) }
    }
}

macro_rules! jacobians {
    ($($(#[$doc:meta])* $name:ident($($arg:ident: $ty:ty),*) $id:ident;)*) => { $(
        $(#[$doc])*
        ///
        /// # Errors
        ///
        /// The data belong to another model, there is no such object, or the plan left out the fields from which the Jacobian is
        /// computed.
        pub fn $name<S: Scope>(
            m: &Model,
            d: &Data<S>,
            $($arg: $ty,)*
            which: &(impl ObjectKey<$id> + ?Sized),
        ) -> Result<PointJacobian, Error> {
            d.belongs_to(m)?;
            let id = which.find_in(&d.names)?;
            call::$name(m, d, $([$arg.x, $arg.y, $arg.z],)* id).map(|j| PointJacobian::from_rows(m, &j))
        }
    )* };
}
jacobians! {
    /// The Jacobian of a point that moves with a body, given in world coordinates, m (`mj_jac`).
    jac(point: Point3<f64>) BodyId;
    /// The Jacobian of the frame of a body (`mj_jacBody`).
    jac_body() BodyId;
    /// The Jacobian of a body's centre of mass (`mj_jacBodyCom`).
    jac_body_com() BodyId;
    /// The Jacobian of the frame of a geom (`mj_jacGeom`).
    jac_geom() GeomId;
    /// The Jacobian of the frame of a site (`mj_jacSite`).
    jac_site() SiteId;
    /// The time derivative of the Jacobian of a point that moves with a body (`mj_jacDot`): the acceleration of the point is
    /// J q̈ + J̇ q̇.
    jac_dot(point: Point3<f64>) BodyId;
}

/// 3 × nv: the Jacobian of the centre of mass of a body and all its descendants, m/s, world axes (`mj_jacSubtreeCom`).
///
/// # Errors
///
/// As for [`jac_body`].
pub fn jac_subtree_com<S: Scope>(
    m: &Model,
    d: &Data<S>,
    which: &(impl ObjectKey<BodyId> + ?Sized),
) -> Result<DMatrix<f64>, Error> {
    d.belongs_to(m)?;
    let rows = call::jac_subtree_com(m, d, which.find_in(&d.names)?)?;
    Ok(DMatrix::from_row_slice(3, m.nv, &rows))
}

/// nefc × nv: the Jacobian of the active constraints (`efc_J`).
///
/// # Errors
///
/// The data belong to another model, or the plan left the constraints out.
pub fn full_j<S: Scope>(m: &Model, d: &Data<S>) -> Result<DMatrix<f64>, Error> {
    let rows = call::full_j(m, d)?;
    let count = rows.len().checked_div(m.nv).unwrap_or(0);
    Ok(DMatrix::from_row_slice(count, m.nv, &rows))
}

/// nv × nv: the mass matrix M, symmetric and positive definite, kg, kg m or kg m² (`mj_fullM`). It contains the armature of
/// joints.
///
/// # Errors
///
/// The data belong to another model, or the plan left M out.
pub fn full_m<S: Scope>(m: &Model, d: &Data<S>) -> Result<DMatrix<f64>, Error> {
    Ok(DMatrix::from_row_slice(m.nv, m.nv, &call::full_m(m, d)?))
}

/// The solution x of M x = b, with the factorization that the step uses (`mj_solveM`). For forces b, x contains accelerations.
///
/// # Errors
///
/// The data belong to another model, b does not have nv numbers, or the plan left the factorization out.
pub fn solve_m<S: Scope>(m: &Model, d: &Data<S>, b: &DVector<f64>) -> Result<DVector<f64>, Error> {
    let mut x = b.clone();
    call::solve_m(m, d, x.as_mut_slice())?;
    Ok(x)
}
