//! The step of a rigid-body simulation with the semantics of MuJoCo 3.14.0.
//!
//! Each stage takes the model, the fields and the scratch of its module. The crate also contains the table of fields, reflection,
//! and the algorithms that compile models. `labspec-core` reads MJCF, provides the interface for embedders, and checks the arguments
//! of callers. Functions of this crate expect a model that `labspec-core` compiled, and data of that model.
//!
//! The two crates are separate because a profile of Cargo applies to a whole crate: the WebAssembly modules optimize this crate for speed,
//! and `labspec-core` for size.
#![forbid(unsafe_code)]
#![recursion_limit = "256"]
// Modules are public for `labspec-core` alone; readers of these pages work on the engine.
#![allow(rustdoc::private_intra_doc_links)]

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
