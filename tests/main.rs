//! Tests that cross crates.

mod lessons;
