//! From syntax tree to typed program, in three passes. `names` resolves every name. `types` infers every type and builds
//! the typed tree. `lints` uses both results to report code that is allowed but rarely intended. Each pass relies on the
//! results of the earlier ones. A mistake is reported once, by the pass that finds it.

mod compiler;
mod lints;
mod names;
mod source;
mod types;

pub use compiler::{Compiled, Compiler};
