//! The `labspec` program in this process.

use crate::error::error;
use facade::{interrupt, threads};
use pyo3::prelude::*;
use std::ffi::OsString;
use std::io::{Write, stdout};
use std::sync::atomic::Ordering;

/// Runs the program with the arguments of a command line, of which the first is its name. Returns the exit code.
#[pyfunction]
pub(crate) fn run_program(py: Python<'_>, arguments: Vec<OsString>) -> PyResult<u8> {
    // An earlier run in this process may have ended with Ctrl-C.
    interrupt::flag().store(false, Ordering::Relaxed);
    let code = py.detach(|| {
        let code = threads::catch_panic(|| labspec_cli::run_program(arguments));
        // Not flushed at the end of a process that is Python's. A failure was the outcome of the command.
        let _ = stdout().flush();
        code
    });
    interrupt::flag().store(false, Ordering::Relaxed);
    code.map_err(|panic| error("panic", &format!("labspec failed: {panic}; report it"), &[]))
}

/// Whether the package may contain a faster build of this module for this processor.
#[pyfunction]
pub(crate) fn runs_faster_build() -> bool {
    labspec_cli::runs_faster_build()
}
