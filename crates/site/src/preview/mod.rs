//! `labspec preview`: the pages of a course while they are written, served to this machine only.
//!
//! | module | contents |
//! |---|---|
//! | `backend` | what the program does for the server: checks, fixes, proposals, writing of lessons |
//! | `author` | a lesson's page with its findings, its claims, and tools for each block |
//! | `snapshot` | all pages after a check, with the texts for which they were made |
//! | `http` | requests and answers |
//! | `guard` | which requests are answered: of this address, of this page, with its token |
//! | `actions` | what a page may ask for |
//! | `assist` | findings, completions and hover texts of an open editor |
//! | `events` | the pages that wait for a change |
//! | `server` | the loop of requests, and that of checks |

mod actions;
mod assist;
mod author;
mod backend;
mod events;
mod guard;
mod http;
mod server;
mod snapshot;

pub use backend::{Backend, CourseCheck, Fingerprint, Proposals, VerifyProposal};
pub use server::{PreviewOptions, serve};
