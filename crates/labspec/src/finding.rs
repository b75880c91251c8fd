//! Findings with their location in a file.

use crate::source::SourceFile;
pub use labspec_finding::{Applicability, ClaimId, Finding, Fix, Place, Severity, sort};

/// Assigns a file to a finding.
pub trait InFile {
    /// Sets the file of the finding and of those related places that do not name another one, and widens spans that begin
    /// or end inside a character.
    fn at(self, file: &SourceFile) -> Self;
}

impl InFile for Finding {
    fn at(mut self, file: &SourceFile) -> Finding {
        for place in self.related.iter_mut().filter(|place| place.path.is_empty()) {
            place.path = file.path().clone();
            place.span = file.snap(&place.span);
        }
        self.span = file.snap(&self.span);
        if let Some(fix) = &mut self.fix {
            fix.span = file.snap(&fix.span);
        }
        self.path = file.path().clone();
        self
    }
}
