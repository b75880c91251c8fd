//! A rigid-body engine with MuJoCo 3.14.0's semantics. It knows nothing of labs or expressions.
#![forbid(unsafe_code)]

mod data;
mod fields;
mod model;
pub mod reflect;

pub use data::{Contact, Data, Warning, WarningStat};
pub use model::{Model, Names, Obj, Options, Statistic, disable, enable, geom, integrator, joint};

mod reset {
    pub(crate) fn reset_data(_m: &crate::Model, _d: &mut crate::Data) {}
}
