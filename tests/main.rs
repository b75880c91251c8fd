//! Tests that cross crates.

mod allocation;
mod breaking;
mod cli;
mod cli_run;
mod conformance;
mod constrained;
mod format;
mod fuzz;
mod javascript;
mod labs;
mod lessons;
mod needs;
mod numbers;
mod parity;
mod plan;
mod program;
mod readme;
mod recorded;
mod scenes;
mod sleep;
mod stability;
mod standing;
mod support;
mod verify;
mod zoo;
mod zz;
