//! Checks that physics lessons tell the truth.
//!
//! A lesson (Markdown with labs and quizzes as JSON in fences) goes in; findings with places come out.
//!
//! * [`source`]: files, places, and maps from derived text back to the file
//! * [`markdown`]: fences, also damaged ones
//! * [`json`]: JSON with a place for every value
//! * [`spec`]: labs, quizzes and lessons as typed values; [`lint::load_lesson_at`] is the way in
//! * [`lint`]: the table of rules and the checks of structure
//! * [`format`](mod@format): the code of a lesson laid out anew
//! * [`ledger`]: every claim with what became of it, from which all verdicts and exit codes follow
//! * [`finding`], [`report`]: what is wrong, and how it is shown to people and programs
//!
//! Frontends hold three objects, and the rest through them: a [`Player`] is a lab that is open on a page, a [`Checker`]
//! checks lessons from memory, an [`Engine`] is a model with the language (it comes from the crate `labspec-bind`, which needs no
//! lessons). [`Models`] is where models come from.

pub mod bind;
pub mod check;
pub mod checker;
pub mod error;
pub mod finding;
pub mod format;
pub mod interrupt;
pub mod json;
pub mod ledger;
pub mod lint;
pub mod markdown;
pub mod models;
pub mod monitors;
mod pairwise;
pub mod player;
mod printable;
pub mod reference;
pub mod repair;
pub mod report;
pub mod rules;
pub mod run;
pub mod source;
pub mod spec;
pub mod stress;
pub mod threads;
pub mod verify;

pub use checker::{Checker, Report};
pub use error::Error;
pub use finding::Finding;
pub use labspec_bind::{Engine, Expression, Functions, Statements, Value};
pub use models::{Models, NoModels};
pub use player::Player;
