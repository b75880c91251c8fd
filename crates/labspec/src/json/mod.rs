//! JSON with a place for every value.
//!
//! Authors write strict JSON (the page reads it with `JSON.parse`), so every leniency of the parser is off and
//! what it would still let through is refused here: acceptance is that of `serde_json`, by a property test.
//! An error is told in the words of a person who does not know what a token is.

mod explain;
mod guard;
mod nearest;
mod parse;
pub(crate) mod read;
mod strings;

pub use nearest::nearest;
pub use parse::{Json, Member, Node, parse};
pub use read::{Fields, Number, Scalar};

/// Deepest nesting of arrays and objects. Labs need about 8.
pub const MAX_DEPTH: usize = 64;
/// Most values in one JSON text. Labs have a few hundred.
pub const MAX_VALUES: usize = 20_000;
