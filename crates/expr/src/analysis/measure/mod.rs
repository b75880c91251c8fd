//! Which dimension every number of a text has, as far as it is certain, read off its form.
//!
//! Numbers of the text may stand for quantities of any dimension; what cannot be known is unknown. A list and a record have the
//! dimension that all of their elements have, a text that of the number which it was made from.
//!
//! | piece | module |
//! |---|---|
//! | one function: its blocks again and again, until nothing changes; calls of others | `flow` |
//! | one operation | `operation` |
//! | what methods and free functions hand on | `natives` |

mod flow;
mod measured;
mod natives;
mod operation;

pub(crate) use flow::measured;
pub use measured::{DimensionClash, DimensionStore, KnownDimensions, TextDimensions};
