//! What a check has to say, whoever checks: the compiler of models, the language, the rules of lessons, a run.
//!
//! A [`Rule`] says once what is wrong, why it matters, and how the wrong and the right thing look. A [`Finding`] is one
//! place where a rule is broken, in words for the person who wrote it. The engine, the language and the lessons speak in this
//! one type, so that a program that shows findings knows one type, too.

mod finding;
mod nearest;
mod pages;
mod place;
mod rule;
mod severity;

pub use finding::{Applicability, ClaimId, Finding, Fix, sort};
pub use nearest::{distance, nearest, ranked};
pub use pages::list_rules;
pub use place::{EditorPosition, Lines, Place, Position, Span, floor};
pub use rule::{Example, Layer, Rule};
pub use severity::Severity;
