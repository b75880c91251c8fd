//! Tests that cross crates.

mod lessons;
mod numbers;
mod parity;
mod support;
mod verify;
