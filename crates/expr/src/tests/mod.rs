//! Tests of the whole road, from text to value, against a small host.

mod arithmetic;
mod generator;
mod javascript;
mod language;
mod math;
mod mistakes;
mod node;
mod operations;
mod programs;
pub(crate) mod roundtrip;
mod semantics;
mod writes;
mod written;
