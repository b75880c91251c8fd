//! Dimension analysis: the dimension of every number of a program, as far as it is certain, derived from the SSA form.
//!
//! A literal number may be a quantity of any dimension. What cannot be determined is unknown. The dimension of a list or a
//! record is the one that all elements have; that of a string is the dimension of the number from which it was made.
//!
//! | piece | module |
//! |---|---|
//! | one function: its blocks, repeated until nothing changes; calls of other functions | `flow` |
//! | one operation | `operation` |
//! | results of methods and free functions | `natives` |

mod flow;
mod measured;
mod natives;
mod operation;

pub(crate) use flow::measured;
pub use measured::{AngleArgument, DimensionClash, DimensionStore, KnownDimensions, TextDimensions};
