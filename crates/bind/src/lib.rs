//! The accessor language over the engine: names are those of the field table, programs run over a model and its data. It knows
//! nothing of labs and lessons.
//!
//! An [`Engine`] is a model with the language: what it takes to ask a simulation for a number in one line. Below it,
//! [`ModelNames`] answers the language's questions at compile time, [`World`] at run time, and [`functions`] is the one table of
//! what programs may call; [`Functions`] are those that an embedding program brings.

mod displayed;
mod elements;
mod embedded;
mod engine;
mod enums;
mod error;
mod field_entry;
pub mod functions;
mod handle;
mod host;
mod host_terms;
mod measures;
mod names;
pub mod rules;
mod unit_grammar;
mod unit_table;
pub mod units;
mod world;

pub use displayed::DisplayedLabels;
pub use elements::element_owner;
pub use embedded::Functions;
pub use engine::{Engine, Expression, Statements};
pub use error::Error;
pub use field_entry::named_field;
pub use host_terms::HOST_TERMS;
pub use labspec_expr::Value;
pub use names::{ModelNames, Scope};
pub use world::{NUMBERS, World};
