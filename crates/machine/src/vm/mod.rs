//! The virtual machine: a flat list of operations on two register files, one for doubles and one for values of any type.
//!
//! A boolean is stored in a number register as 1 or 0; `emit` knows which registers contain booleans. Constants are written to
//! their registers before the first operation of a function. Every backward jump charges the cost of the operations that it
//! repeats, and every call that of the function, so that every run terminates with a known cost.

mod calls;
mod collections;
mod fields;
mod index;
mod machine;
mod noting;
mod operands;
mod step;

pub use machine::{MAX_WORK, run};
