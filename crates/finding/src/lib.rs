//! Findings, the common type of all checks: the model compiler, the language, the rules of lessons, and runs.
//!
//! A [`Rule`] describes one kind of mistake: what is wrong, why it matters, and a wrong and a right example. A [`Finding`] is
//! one violation of a rule, described for the author. The engine, the language and the lessons use this one type, so that a
//! program that displays findings needs only one type as well.

#[cfg_attr(not(feature = "docs"), path = "no_example.rs")]
mod example;
mod finding;
mod nearest;
mod numbers;
pub mod order;
mod pages;
mod place;
mod rule;
mod severity;

pub use example::Example;
pub use finding::{Applicability, ClaimId, Finding, Fix, sort};
pub use nearest::{distance, nearest, ranked};
pub use numbers::{scientific, two_digits, without_zeros};
pub use pages::list_rules;
pub use place::{EditorPosition, Lines, Place, Position, Span, floor};
pub use rule::{Layer, Rule};
pub use severity::Severity;

/// Whether this build has the descriptions of tables for authors: the feature `descriptions`.
pub const DESCRIBED: bool = cfg!(feature = "descriptions");

/// A description for authors. Empty in a build without the feature `descriptions`.
pub const fn docs(text: &'static str) -> &'static str {
    if DESCRIBED { text } else { "" }
}
