//! A server for editors, following the Language Server Protocol 3.17: diagnostics, completion, hover texts with values at the
//! start of a lab, navigation to names of models, and fixes.
//!
//! * `wire`: parses messages from arbitrary bytes; `server`: the main loop; `state`: its state
//! * `initialize`, `requests`, `document_requests`, `commands`, `notifications`: the handlers of messages; `answers`: what requests
//!   share
//! * `documents`, `convert`, `context`: the documents of the editor, its positions and URIs, the models and
//!   lessons around a document
//! * `runs`, `proofs`: checks with runs, and claims for numbers of the text, on separate threads; `diagnostic`, `edits`:
//!   conversion of findings and edits
//! * `complete`, `hover`, `signature`, `names`, `rename`, `actions`, `hints`, `outline`, `lenses`: one request each
//!
//! What is independent of the protocol is in `labspec-assist`: findings while typing, completions, hover texts, fixes.

mod actions;
mod answers;
mod commands;
mod complete;
mod context;
mod convert;
mod course;
mod diagnostic;
mod document_requests;
mod documents;
mod edits;
mod hints;
mod hover;
mod initialize;
mod lenses;
mod names;
mod notifications;
mod outline;
mod proofs;
mod rename;
mod requests;
mod runs;
mod server;
mod signature;
mod state;
mod wire;

pub use server::serve;
pub use state::CourseConfig;
