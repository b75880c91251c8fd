//! The first pass: what every name of a text means. A name is either declared in the text, or it belongs to the language or
//! the host; anything else is a mistake, and is reported here.
//!
//! The walk goes through a text as it runs: a function is looked into where it is first named, so that a variable it uses is
//! known to have a value by then, or not. What the walk finds of a variable (is it assigned again? do functions share it?) the
//! next pass takes as given.

mod declared;
mod language;
mod meant;
mod statement;
mod unknown;
mod walk;

pub(super) use declared::{Declaration, NameMeaning, NameTable};
pub(super) use language::{MACHINERY, NAMESPACES, list_names};
pub(super) use meant::meant_elsewhere;
pub(super) use statement::names_of;
pub(super) use walk::{Surroundings, resolve};
