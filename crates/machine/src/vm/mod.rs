//! The machine: flat operations on two files of registers, one of doubles and one of values of any type.
//!
//! A boolean lives in a number register as 1 or 0; `emit` knows which it is. Constants stand in registers
//! before the first operation of a function. Every jump back counts the operations that it repeats, every call those of the
//! function, so every run ends, and what it cost is known.

mod calls;
mod collections;
mod fields;
mod index;
mod machine;
mod noting;
mod operands;
mod step;

pub use machine::{MAX_WORK, run};
