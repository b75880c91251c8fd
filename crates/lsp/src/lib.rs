//! The program as a server of editors, after the Language Server Protocol 3.17: what is wrong as one types, what can be written,
//! what a name means and is worth at the start of its lab, where it stands in the model, and what repairs it.
//!
//! * `wire`: messages from bytes, whatever the bytes are; `server`: the loop; `state`: what it holds
//! * `initialize`, `requests`, `notifications`: each message as its type of the protocol, and what it does
//! * `documents`, `convert`, `context`: what the editor holds, positions and URIs as it names them, the models and lessons around
//! * `check`, `runs`, `diagnostic`: what is found as one types, what runs find on a thread of their own, how it is reported
//! * `code`, `elements`, `start`: the texts of a lesson that are code, the names in a model, labs at their start
//! * `complete`, `hover`, `names`, `rename`, `actions`, `hints`: an answer each

mod actions;
mod check;
mod code;
mod complete;
mod context;
mod convert;
mod diagnostic;
mod documents;
mod elements;
mod hints;
mod hover;
mod initialize;
mod names;
mod notifications;
mod rename;
mod requests;
mod runs;
mod server;
mod start;
mod state;
mod wire;

pub use server::serve;
pub use state::CourseConfig;
