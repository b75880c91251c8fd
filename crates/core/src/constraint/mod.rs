//! Soft constraints: rows, their stiffness and damping, independent islands, and the solver.
//!
//! The dynamics with constraints is a convex problem (Todorov 2014, *Convex and analytically-invertible
//! dynamics with contacts and constraints*): among all accelerations, the one nearest to the unconstrained
//! in the metric of M, where each constraint adds a cost for missing its reference acceleration.

mod impedance;
mod island;
mod jacobian;
mod rows;
mod search;
mod solver;

pub(crate) use island::Islands;
pub(crate) use jacobian::Jacobian;
pub(crate) use rows::{make, reference};
pub(crate) use solver::{Scratch, inverse, solve};

/// Values of `efc_type` (mjtConstraint).
pub(crate) mod kind {
    pub(crate) const EQUALITY: i32 = 0;
    pub(crate) const LIMIT_JOINT: i32 = 3;
    pub(crate) const LIMIT_TENDON: i32 = 4;
    pub(crate) const CONTACT_FRICTIONLESS: i32 = 5;
    pub(crate) const CONTACT_PYRAMIDAL: i32 = 6;
}
