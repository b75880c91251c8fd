//! Soft constraints: rows, their stiffness and damping, independent islands, and the solvers.
//!
//! The constrained dynamics is a convex problem (Todorov 2014, *Convex and analytically-invertible dynamics with
//! contacts and constraints*). Its solution minimizes the squared distance from the unconstrained acceleration in the
//! metric M, plus a cost for each constraint that deviates from its reference acceleration.

mod cg;
mod cone;
mod contact_rows;
mod cost;
mod delassus;
mod dual;
pub mod ends;
mod equality_rows;
mod exact;
mod force;
mod hessian;
mod impedance;
mod implicit_rows;
mod island;
mod iterate;
mod jacobian;
mod make;
mod newton;
mod noslip;
mod pgs;
mod primal;
mod reference;
mod row_counts;
mod rows;
mod search;
mod single;
mod six;
mod solver;

pub use force::contact_force;
pub(crate) use implicit_rows::{at_end_of_step, pop_metric, push_metric};
pub use jacobian::full_j;
pub(crate) use make::{make, none};
pub(crate) use reference::reference;
pub(crate) use single::tendon_force;
pub(crate) use solver::{inverse, solve, unconstrained_residual};

use crate::dynamics::jacobian::Columns;
use crate::kinds;
use crate::model::Model;
pub(crate) use island::Islands;
use iterate::Iterate;
use jacobian::ConstraintJacobian;

/// Scratch memory of the constraint stages, kept between stages and between steps.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ConstraintScratch {
    /// Jacobian of the constraints.
    pub jac: ConstraintJacobian,
    /// Columns of one contact's Jacobian.
    columns: Columns,
    pub(crate) islands: Islands,
    solver: Iterate,
    /// A column of M⁻¹ Jᵀ.
    column: Vec<f64>,
}

impl ConstraintScratch {
    pub(crate) fn new(m: &Model) -> ConstraintScratch {
        ConstraintScratch { columns: Columns::with_room(m.nv), ..ConstraintScratch::default() }
    }
}

/// Number of degrees of freedom below which matrices are dense if the model does not specify it.
const MOST_DENSE: usize = 60;

/// Whether MuJoCo would use dense matrices. It then drops rows whose values are all zero; with sparse matrices it
/// drops rows without columns.
fn is_dense(m: &Model) -> bool {
    match m.opt.jacobian {
        kinds::jacobian::AUTO => m.nv < MOST_DENSE,
        kind => kind == kinds::jacobian::DENSE,
    }
}

/// Values of `efc_type` (mjtConstraint).
pub(crate) mod kind {
    pub(crate) const EQUALITY: i32 = 0;
    pub(crate) const FRICTION_DOF: i32 = 1;
    pub(crate) const FRICTION_TENDON: i32 = 2;
    pub(crate) const LIMIT_JOINT: i32 = 3;
    pub(crate) const LIMIT_TENDON: i32 = 4;
    pub(crate) const CONTACT_FRICTIONLESS: i32 = 5;
    pub(crate) const CONTACT_PYRAMIDAL: i32 = 6;
    pub(crate) const CONTACT_ELLIPTIC: i32 = 7;
}
