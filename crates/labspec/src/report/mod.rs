//! Findings for people and for programs.

#[cfg(feature = "report")]
mod formats;
#[cfg(feature = "report")]
pub mod html;
#[cfg(feature = "report")]
mod human;
mod machine;
mod nonfinite;
#[cfg(feature = "report")]
mod sarif;
#[cfg(feature = "report")]
mod schema_parts;
mod table;
#[cfg(feature = "report")]
pub mod uri;

pub use crate::json::to_value;
pub use crate::printable::{capital, counted, printable, printable_json, printable_lines, printable_path};
#[cfg(feature = "report")]
pub use formats::{concise, github, gitlab, jsonl, junit, statistics};
#[cfg(feature = "report")]
pub use human::human;
pub use machine::{FindingRow, PlaceFields, SCHEMA_VERSION, json, key, report, set_number, set_numbers};
pub use nonfinite::nonfinite;
#[cfg(feature = "report")]
pub use nonfinite::{NonfiniteEntries, NonfiniteName};
#[cfg(feature = "report")]
pub use sarif::{page, sarif};
#[cfg(feature = "report")]
pub use schema_parts::PartOf;
#[cfg(feature = "report")]
pub use table::RunReport;
pub use table::{TableReport, number_in_table};

use crate::finding::{Finding, Severity};
use crate::source::SourceFile;
use serde::Serialize;

/// Number of findings of each severity.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Summary {
    /// Errors.
    pub errors: usize,
    /// Warnings.
    pub warnings: usize,
    /// Notes.
    pub notes: usize,
}

impl Summary {
    /// Counts findings.
    pub fn count(findings: &[Finding]) -> Summary {
        let count = |severity| findings.iter().filter(|f| f.severity == severity).count();
        Summary {
            errors: count(Severity::Error),
            warnings: count(Severity::Warning),
            notes: count(Severity::Note),
        }
    }
}

impl std::fmt::Display for Summary {
    /// `2 errors, 1 warning`, or `no findings`. This is not a verdict: see [`crate::ledger`].
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let parts: Vec<String> = [(self.errors, "error"), (self.warnings, "warning"), (self.notes, "note")]
            .into_iter()
            .filter(|(n, _)| *n > 0)
            .map(|(n, word)| counted(n, word))
            .collect();
        match parts.is_empty() {
            true => f.write_str("no findings"),
            false => f.write_str(&parts.join(", ")),
        }
    }
}

/// The file with a path, among the files that were read.
fn file_of<'a>(files: &[&'a SourceFile], path: &str) -> Option<&'a SourceFile> {
    files.iter().copied().find(|f| &**f.path() == path)
}
