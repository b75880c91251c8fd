//! Tests that cross crates.

mod lessons;
mod parity;
mod support;
