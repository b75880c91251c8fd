//! The `labspec` program. Exit code 0: clean; 1: findings; 2: could not run or print; 130: stopped by Ctrl-C.

use std::process::ExitCode;

fn main() -> ExitCode {
    labspec::cli::main(std::env::args_os())
}
