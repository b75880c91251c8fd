//! The error type of the library: for models, programs and runs.

use crate::finding::{Finding, InFile};
use crate::run::RunError;
use crate::source::SourceFile;
pub use labspec_bind::Error;

impl From<RunError> for Error {
    fn from(e: RunError) -> Error {
        Error::Call(e.to_string())
    }
}

/// A finding in a file, with line and column.
pub(crate) fn located(finding: Finding, file: &SourceFile) -> Finding {
    let mut finding = if finding.path.is_empty() { finding.at(file) } else { finding };
    if finding.path == *file.path() {
        finding.position = Some(file.position(finding.span.start));
    }
    finding
}
