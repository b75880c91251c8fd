//! The programs of a lab, bound to its model: [`Programs`]. The names and the world in which programs run are defined by
//! the crate `labspec-bind`, which does not depend on labs.

mod compile;
pub(crate) mod coupled;
mod dimension;
mod labels;
mod model_file;
pub mod parts;
mod programs;
pub mod scene;
mod unknown_names;

pub use compile::scalar;
pub use compile::to_finding;
pub(crate) use dimension::given;
pub use dimension::given_by;
pub use dimension::{Dimensions, dimension_of, dimensions};
pub use labels::of_label;
pub(crate) use labels::{behind_heading, contradicts, in_degrees, of_heading, unit_beside};
pub use labspec_bind::{DisplayedLabels, Functions, ModelNames, NUMBERS, Playback, Scope, World, functions};
pub(crate) use model_file::compile_to_play;
pub(crate) use programs::writes_kind;
pub use programs::{ActionProgram, Bound, ControlProgram, Probe, Programs, include};
