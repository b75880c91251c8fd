//! The first pass: resolves every name of a source text. A name is declared in the text, or belongs to the language or the
//! host. Anything else is an error and is reported here.
//!
//! The walk follows the order of execution. It visits a function where the function is first named, to determine whether
//! the variables that the function uses have a value by then. The next pass relies on the properties of variables that the
//! walk finds: whether a variable is reassigned, and whether functions share it.

mod declared;
mod language;
mod meant;
mod python;
mod statement;
mod unknown;
mod walk;

pub(super) use declared::{Declaration, NameMeaning, NameTable};
pub(super) use language::{INTERNAL_MEMBERS, NAMESPACES, list_names};
pub(super) use meant::meant_elsewhere;
pub(super) use statement::names_of;
pub(super) use walk::{NameContext, resolve};
