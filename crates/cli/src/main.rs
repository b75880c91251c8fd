//! The `labspec` program. Exit code 0: clean; 1: findings; 2: could not run or print; 3: not everything requested was checked; 130:
//! stopped by Ctrl-C.

fn main() -> std::process::ExitCode {
    labspec_cli::start_faster_program();
    labspec_cli::run_program(std::env::args_os()).into()
}
