//! Where the language meets the engine: names to fields of the table, programs to a running world.
//!
//! [`ModelNames`] answers the language's questions at compile time from the engine's field table, [`World`] answers
//! them at run time, [`functions`] is the one table of functions, and [`Programs`] holds everything that a lab
//! computes, bound to its model.

mod compile;
mod elements;
mod enums;
pub mod functions;
mod handle;
mod names;
pub mod parts;
pub mod scene;
pub(crate) mod words;
mod world;

pub use compile::{ActionProgram, Bound, ControlProgram, Probe, Programs, to_finding};
pub(crate) use compile::{include, scalar, writes_kind};
pub(crate) use names::named_field;
pub use names::{ModelNames, Scope};
pub use world::World;
