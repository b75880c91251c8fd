//! Checks that physics lessons tell the truth.
//!
//! A lesson (Markdown with labs and quizzes as JSON in fences) goes in; findings with places come out.
//!
//! * [`source`]: files, places, and maps from derived text back to the file
//! * [`markdown`]: fences, also damaged ones
//! * [`json`]: JSON with a place for every value
//! * [`spec`]: labs, quizzes and lessons as typed values; [`spec::load_lesson`] is the way in
//! * [`lint`]: the table of rules and the checks of structure
//! * [`format`](mod@format): the code of a lesson laid out anew
//! * [`ledger`]: every claim with what became of it, from which all verdicts and exit codes follow
//! * [`finding`], [`report`]: what is wrong, and how it is shown to people and programs

pub mod advice;
pub mod bind;
pub mod check;
pub mod cli;
mod digest;
pub mod finding;
pub mod format;
mod interrupt;
pub mod json;
pub mod ledger;
pub mod lint;
pub mod markdown;
pub mod precision;
pub mod reference;
pub mod report;
pub mod rules;
pub mod run;
pub mod source;
pub mod spec;
pub mod svg;
pub mod verify;
