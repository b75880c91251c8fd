//! Everything that a lab computes, bound to its model: [`Programs`]. What names mean, and the world that programs run in, is the
//! business of the crate `labspec-bind`, which knows no labs.

mod compile;
pub(crate) mod coupled;
mod dimension;
mod labels;
pub mod parts;
pub mod scene;

pub use compile::include;
pub use compile::{ActionProgram, Bound, ControlProgram, Probe, Programs, to_finding};
pub(crate) use compile::{scalar, writes_kind};
pub use dimension::{Dimensions, dimension_of, dimensions};
pub(crate) use dimension::{given, given_by};
pub(crate) use labels::{behind_heading, contradicts, of_heading, of_label, unit};
pub(crate) use labspec_bind::named_field;
pub use labspec_bind::{Functions, ModelNames, NUMBERS, Scope, Shown, World, functions};
