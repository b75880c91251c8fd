//! Tests that cross crates.

mod allocation;
mod cli;
mod lessons;
mod numbers;
mod parity;
mod plan;
mod scenes;
mod support;
mod verify;
