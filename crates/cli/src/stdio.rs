//! Standard output and standard error. A full device is an error; a reader that has closed the pipe is not.

use super::common::Failure;
use labspec::report::printable_json;
use serde::Serialize;
use std::io::{self, BufWriter, IsTerminal, Write};

/// Prints to standard output. If the reader has closed the pipe (`| head`), the program ends quietly.
///
/// Text from a lesson must pass through [`labspec::report::printable`] before it becomes part of `text`.
pub(super) fn print(text: &str) -> Result<(), Failure> {
    stream(|out| out.write_all(text.as_bytes()))
}

/// Prints a value as JSON without characters that control a terminal.
pub(super) fn print_json(value: &impl Serialize, pretty: bool) -> Result<(), Failure> {
    let text = if pretty { serde_json::to_string_pretty(value) } else { serde_json::to_string(value) };
    let text = text.map_err(|e| e.to_string())?;
    print(&format!("{}\n", printable_json(&text)))
}

/// Prints output that is written in pieces and never stored as a whole.
pub(super) fn stream(write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), Failure> {
    let mut out = BufWriter::with_capacity(1 << 16, io::stdout().lock());
    let done = write(&mut out).and_then(|()| out.flush());
    // Dropping the buffer would write the rest again, to an output that has just failed.
    let _ = out.into_parts();
    outcome(done)
}

/// The outcome of printing.
pub(super) fn outcome(done: io::Result<()>) -> Result<(), Failure> {
    match done {
        Err(e) if e.kind() != io::ErrorKind::BrokenPipe => {
            Err(format!("cannot write to standard output: {e}"))
        }
        _ => Ok(()),
    }
}

/// Prints to standard error. A failure is ignored, because it cannot be reported anywhere.
pub(super) fn print_error(text: &str) {
    let _ = io::stderr().lock().write_all(text.as_bytes());
}

/// Replaces the progress line on a terminal.
pub(super) fn show_progress(text: &str) {
    print_error(&format!("\r\x1b[K{text}"));
}

/// Clears the progress line.
pub(super) fn clear_progress() {
    show_progress("");
}

/// A progress line on a terminal, which is cleared at the end of the work.
pub(super) struct Progress {
    is_visible: bool,
}

impl Progress {
    /// Creates the progress line; it is visible if the output is for people and standard error is a terminal.
    pub(super) fn new(for_people: bool) -> Progress {
        Progress { is_visible: for_people && io::stderr().is_terminal() }
    }

    /// Displays the current activity.
    pub(super) fn report(&self, text: &str) {
        if self.is_visible {
            show_progress(text);
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.report("");
    }
}
