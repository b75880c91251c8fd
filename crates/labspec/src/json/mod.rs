//! JSON with a span for every value, read to its end whatever errors it contains.
//!
//! A page reads a block with `JSON.parse`: a single wrong character makes the whole block unreadable. So acceptance is
//! strict (equal to that of `serde_json`, checked by a property test), but the parser continues after every error. Each
//! error is reported at its location, in words for people who do not know what a token is. The intended value is read, so
//! that the rest of the block is checked too.

mod gaps;
#[cfg(test)]
mod law_tests;
mod layout;
pub(crate) mod literal;
mod node;
mod parse;
mod parser;
mod problem;
mod punctuation;
mod quoted;
pub(crate) mod read;
mod strings;
#[cfg(test)]
mod tests;

pub use labspec_finding::nearest;
pub use layout::lay_out;
pub use node::{Json, Member, Node};
pub use parse::{Parsed, parse};
pub use problem::{Mistake, Problem};
pub use read::{Number, Scalar};
pub use strings::encode;
pub(crate) use strings::{fix_in, fix_in_code};

/// Maximum nesting depth of arrays and objects. Labs need about 8.
pub const MAX_DEPTH: usize = 64;
/// Maximum number of values in one JSON text. Labs have a few hundred.
pub const MAX_VALUES: usize = 20_000;
/// Maximum number of reported errors of one JSON text.
pub const MAX_ERRORS: usize = 200;

/// Serializes a value of one of our types.
pub fn to_value(value: &impl serde::Serialize) -> serde_json::Value {
    serde_json::to_value(value).unwrap_or_default()
}
