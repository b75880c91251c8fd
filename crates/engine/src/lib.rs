//! The step of a rigid-body simulation with MuJoCo 3.14.0's semantics: what runs all the time.
//!
//! A stage takes the model, the fields and the scratch of its module. The table of fields, reflection and the algorithms
//! that models are compiled with are here, too. Reading MJCF and the interface for embedders, which check what callers
//! pass, are `labspec-core`: functions here take a model that it has compiled, and data of that model.
//!
//! The crates are two because a page's module is built for speed only where it runs in every step.
#![forbid(unsafe_code)]
#![recursion_limit = "256"]

pub mod collision;
pub mod constraint;
pub mod dynamics;
pub mod forces;
pub mod geometry;
pub mod kinds;
pub mod math;
pub mod model;
pub mod query;
pub mod sensor;
pub mod step;
#[cfg(test)]
mod tests;
