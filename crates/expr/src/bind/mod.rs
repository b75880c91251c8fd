//! Tree to meaning, in three passes. `names` finds what every name means. `types` finds which type everything has, and makes the
//! typed tree. `lints` looks at what they found for what is allowed, but hardly ever meant. Each pass takes what the ones before it
//! found as given; mistakes are reported where they are found, once.

mod compiler;
mod lints;
mod names;
mod source;
mod types;

pub use compiler::{Compiled, Compiler};
