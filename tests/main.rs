//! Tests that cross crates.

mod allocation;
mod cli;
mod cli_run;
mod lessons;
mod numbers;
mod parity;
mod plan;
mod program;
mod readme;
mod scenes;
mod support;
mod verify;
