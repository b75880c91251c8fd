//! Tools for engineers of labspec: the time of a step (`bench`), and the numbers of this engine for the states of a recording of MuJoCo
//! (`record`). The program runs them as commands; neither opens a model or prints.

pub mod bench;
mod number_fields;
pub mod record;

pub use number_fields::{NumberFields, Numbers};
