//! JSON with a place for every value, read to its end whatever is wrong with it.
//!
//! The page reads a block with `JSON.parse`: one wrong character and the whole block is gone. So acceptance is strict
//! (that of `serde_json`, by a property test), but reading goes on behind every mistake: each is reported at its place,
//! in the words of a person who does not know what a token is, and what was meant is read as a value, so that the
//! rest of the block is checked too.

mod gaps;
#[cfg(test)]
mod law_tests;
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
pub use node::{Json, Member, Node};
pub use parse::{Parsed, parse};
pub use problem::{Mistake, Problem};
pub use read::{Number, Scalar};
pub use strings::encode;
pub(crate) use strings::{fix_in, fix_in_code};

/// Deepest nesting of arrays and objects. Labs need about 8.
pub const MAX_DEPTH: usize = 64;
/// Most values in one JSON text. Labs have a few hundred.
pub const MAX_VALUES: usize = 20_000;
/// Most mistakes that are reported for one JSON text.
pub const MAX_MISTAKES: usize = 200;

/// What a type of ours writes, as a value.
pub fn to_value(of: &impl serde::Serialize) -> serde_json::Value {
    serde_json::to_value(of).unwrap_or_default()
}
