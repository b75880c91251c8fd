//! What a check has to say, whoever checks: the compiler of models, the language, the rules of lessons, a run.
//!
//! A [`Rule`] says once what is wrong, why it matters, and how the wrong and the right thing look. A [`Finding`] is one
//! place where a rule is broken, in words for the person who wrote it. The engine, the language and the lessons speak in this
//! one type, so that a program that shows findings knows one type, too.

#[cfg_attr(not(feature = "docs"), path = "no_example.rs")]
mod example;
mod finding;
mod nearest;
pub mod order;
mod pages;
mod place;
mod rule;
mod severity;

pub use example::Example;
pub use finding::{Applicability, ClaimId, Finding, Fix, sort};
pub use nearest::{distance, nearest, ranked};
pub use pages::list_rules;
pub use place::{EditorPosition, Lines, Place, Position, Span, floor};
pub use rule::{Layer, Rule};
pub use severity::Severity;

/// A text for people who write lessons: a description, an example. Empty in a build without the feature `docs`.
pub const fn docs(text: &'static str) -> &'static str {
    if cfg!(feature = "docs") { text } else { "" }
}
