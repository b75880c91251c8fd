//! A server for editors, following the Language Server Protocol 3.17: diagnostics, completion, hover texts with values at the
//! start of a lab, navigation to names of models, and fixes.
//!
//! * `wire`: parses messages from arbitrary bytes; `server`: the main loop; `state`: its state
//! * `initialize`, `requests`, `notifications`: the handlers of messages
//! * `documents`, `convert`, `context`: the documents of the editor, its positions and URIs, the models and
//!   lessons around a document
//! * `runs`, `diagnostic`: findings from runs on a separate thread, conversion to diagnostics
//! * `complete`, `hover`, `names`, `rename`, `actions`, `hints`: one request each
//!
//! What is independent of the protocol is in `labspec-assist`: findings while typing, completions, hover texts, fixes.

mod actions;
mod complete;
mod context;
mod convert;
mod diagnostic;
mod documents;
mod hints;
mod hover;
mod initialize;
mod names;
mod notifications;
mod rename;
mod requests;
mod runs;
mod server;
mod state;
mod wire;

pub use server::serve;
pub use state::CourseConfig;
