//! The program as a server of editors, after the Language Server Protocol 3.17: what is wrong as one types, what can be written,
//! what a name means and is worth at the start of its lab, where it stands in the model, and what repairs it.
//!
//! * `wire`: messages from bytes, whatever the bytes are; `server`: the loop, and which request is answered by what
//! * `documents`, `places`, `course`: what the editor holds, places as it names them, the models and lessons around
//! * `look`, `runs`, `diagnostic`: what is found as one types, what runs find on a thread of their own, how it is told
//! * `code`, `elements`: the texts of a lesson that are code, the names in a model
//! * `complete`, `hover`, `names`, `rename`, `actions`, `hints`: an answer each

mod actions;
mod check;
mod code;
mod complete;
mod course;
mod diagnostic;
mod documents;
mod elements;
mod hints;
mod hover;
mod names;
mod places;
mod rename;
mod runs;
mod server;
mod start;
mod wire;

pub use server::{Course, serve};
