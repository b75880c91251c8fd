//! Tools for engineers of labspec: the run time of a step (`bench`), and the values of this engine for the states of a MuJoCo
//! recording (`record`). The program runs them as commands; this crate neither opens models nor prints.

pub mod bench;
mod number_fields;
pub mod record;
mod recorded_fields;

pub use number_fields::{NumberFields, Numbers};
