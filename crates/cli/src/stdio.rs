//! Standard output and standard error: a device that is full is an error, a reader that has gone away is not.

use super::common::Failure;
use labspec::report::printable_json;
use serde::Serialize;
use std::io::{self, BufWriter, IsTerminal, Write};

/// Prints to standard output. A reader that has gone away (`| head`) ends the program quietly.
///
/// What a lesson holds goes through [`labspec::report::printable`] before it becomes part of `text`.
pub(super) fn print(text: &str) -> Result<(), Failure> {
    stream(|out| out.write_all(text.as_bytes()))
}

/// Prints a value as JSON, in which nothing acts on a terminal.
pub(super) fn print_json(value: &impl Serialize, pretty: bool) -> Result<(), Failure> {
    let text = if pretty { serde_json::to_string_pretty(value) } else { serde_json::to_string(value) };
    let text = text.map_err(|e| e.to_string())?;
    print(&format!("{}\n", printable_json(&text)))
}

/// Prints what is written piece by piece and never held as a whole.
pub(super) fn stream(write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), Failure> {
    let mut out = BufWriter::with_capacity(1 << 16, io::stdout().lock());
    let done = write(&mut out).and_then(|()| out.flush());
    // Dropping the buffer would write what is left once more, to an output that has just failed.
    let _ = out.into_parts();
    outcome(done)
}

/// What printing came to.
pub(super) fn outcome(done: io::Result<()>) -> Result<(), Failure> {
    match done {
        Err(e) if e.kind() != io::ErrorKind::BrokenPipe => {
            Err(format!("cannot write to standard output: {e}"))
        }
        _ => Ok(()),
    }
}

/// Prints to standard error. Where that fails there is nobody left to tell.
pub(super) fn complain(text: &str) {
    let _ = io::stderr().lock().write_all(text.as_bytes());
}

/// Replaces the line of progress on a terminal.
pub(super) fn show_progress(text: &str) {
    complain(&format!("\r\x1b[K{text}"));
}

/// Clears the line of progress.
pub(super) fn clear_progress() {
    show_progress("");
}

/// One line on a terminal that says what long work is at, and is gone when it ends.
pub(super) struct Progress {
    is_visible: bool,
}

impl Progress {
    /// Shown where a person looks at the terminal.
    pub(super) fn new(for_people: bool) -> Progress {
        Progress { is_visible: for_people && io::stderr().is_terminal() }
    }

    /// Says what is being done now.
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
