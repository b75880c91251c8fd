//! The accessor language over the engine: names come from the field table, and programs run over a model and its data. It does
//! not depend on labs and lessons.
//!
//! An [`Engine`] is a model with the language, the shortest way to evaluate an expression in a simulation. Below it,
//! [`ModelNames`] implements the language's schema at compile time and [`World`] its host at run time. [`functions`] is the
//! table of all functions that programs can call; [`Functions`] are those of an embedding program.

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
pub use elements::{ElementAxis, describe_element, element_axis, element_owner};
pub use embedded::Functions;
pub use engine::{Engine, Expression, Statements};
pub use error::Error;
pub use field_entry::named_field;
pub use host_terms::{CLAIM_TERMS, HOST_TERMS};
pub use labspec_expr::Value;
pub use names::{ModelNames, Scope};
pub use world::{NUMBERS, Playback, World};
