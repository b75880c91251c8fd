//! Everything that a lab computes, bound to its model: [`Programs`]. What names mean, and the world that programs run in, is the
//! business of the crate `labspec-bind`, which knows no labs.

mod compile;
pub(crate) mod coupled;
mod dimension;
mod labels;
mod model_file;
pub mod parts;
mod programs;
pub mod scene;

pub use compile::scalar;
pub use compile::to_finding;
pub(crate) use dimension::given;
pub use dimension::given_by;
pub use dimension::{Dimensions, dimension_of, dimensions};
pub use labels::of_label;
pub(crate) use labels::{behind_heading, contradicts, of_heading, unit};
pub(crate) use labspec_bind::named_field;
pub use labspec_bind::{DisplayedLabels, Functions, ModelNames, NUMBERS, Scope, World, functions};
pub(crate) use model_file::compile_to_play;
pub(crate) use programs::writes_kind;
pub use programs::{ActionProgram, Bound, ControlProgram, Probe, Programs, include};
