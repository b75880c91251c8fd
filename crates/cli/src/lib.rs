//! The `labspec` program as a library, for programs that contain it, such as the package for Python: one file per command, each a
//! thin layer over the libraries.

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
mod embedding;
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

pub use commands::run_program;
pub use embedding::{LabReport, lesson_report, precision_report, stability_report};
