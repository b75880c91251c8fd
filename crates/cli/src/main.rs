//! The `labspec` program: one file per command, each a thin layer over the libraries. Exit code 0: clean; 1: findings; 2: could
//! not run or print; 3: not everything requested was checked; 130: stopped by Ctrl-C.

mod baseline;
mod build;
mod cache;
mod check;
mod check_output;
mod collect;
mod commands;
mod common;
mod completions;
mod config;
mod conventions;
mod course;
mod course_ledger;
mod developer;
mod digest;
mod explain;
mod file_check;
mod fix;
mod fmt;
mod init;
mod json_schema;
mod judge;
mod lab_args;
#[cfg(feature = "lsp")]
mod lsp;
mod machine;
mod output;
mod output_kind;
mod overview;
mod parallel;
mod plan;
mod policy;
mod precision;
mod preview;
mod report_json;
mod report_schema;
mod reproduction;
mod routes;
mod run;
mod scaffold;
mod scheduler;
mod schema;
mod schema_shape;
mod schema_words;
mod since;
mod snapshot;
mod stability;
mod stdio;
mod target;
mod trace;
mod watch;
mod widgets;

fn main() -> std::process::ExitCode {
    commands::run_program()
}
