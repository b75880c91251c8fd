//! Checks that physics lessons tell the truth.
//!
//! The input is a lesson (Markdown with labs and quizzes as JSON in fences); the output is a list of findings with
//! locations.
//!
//! * [`source`]: files, positions, and maps from derived text back to the file
//! * [`markdown`]: fences, including damaged ones
//! * [`json`]: JSON with a span for every value
//! * [`spec`]: labs, quizzes and lessons as typed values; [`lint::load_lesson_at`] is the entry point
//! * [`lint`]: the table of rules and the structural checks
//! * [`format`](mod@format): formats the code of a lesson
//! * [`ledger`]: every claim with its state, from which all verdicts and exit codes follow
//! * [`listings`]: Python listings with the outputs that a lesson displays
//! * [`finding`], [`report`]: findings, and their output for people and programs
//!
//! Frontends use three objects, and everything else through them: a [`Player`] is a lab that is open on a page, a
//! [`Checker`] checks lessons from memory, an [`Engine`] is a model with the language (from the crate `labspec-bind`, which
//! does not depend on lessons). [`Models`] defines where models come from.

pub mod bind;
pub mod check;
pub mod checker;
pub mod error;
pub mod finding;
pub mod format;
pub mod interrupt;
pub mod json;
pub mod language;
pub mod ledger;
pub mod lint;
pub mod listings;
pub mod markdown;
pub mod models;
mod pairwise;
pub mod player;
mod printable;
#[cfg(feature = "mjcf")]
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

/// Whether tests take all cases: nothing may be left out (`tests/population.rs`).
#[cfg(test)]
fn takes_all() -> bool {
    std::env::var_os("LABSPEC_REQUIRE").is_some_and(|value| value == "all")
}

pub use checker::{Checker, Report};
pub use error::Error;
pub use finding::Finding;
pub use labspec_bind::{Engine, Expression, Functions, Statements, Value};
pub use labspec_monitors as monitors;
pub use models::{Models, NoModels};
pub use player::Player;
