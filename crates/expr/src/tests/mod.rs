//! Tests of the whole pipeline, from text to value, against a small host.

#![allow(clippy::too_many_lines, reason = "generators and tables of cases are lists")]

mod arithmetic;
mod generator;
mod javascript;
mod language;
mod math;
mod mistakes;
mod natives;
mod node;
mod operations;
mod pitfalls;
mod programs;
pub(crate) mod roundtrip;
mod rows;
mod semantics;
mod watch;
mod writes;
mod written;
