//! The data of a page.

use crate::check::{Basis, Checked, SuppressedFinding, VerifyCurves};
use crate::finding::Finding;
use crate::ledger::Ledger;
use crate::source::SourceFile;

/// The data of a page.
#[derive(Clone, Copy, Debug)]
pub struct Material<'a> {
    /// The lessons, in order.
    pub lessons: &'a [Checked],
    /// The curves of the labs of each lesson in the runs of its claims.
    pub curves: &'a [Vec<VerifyCurves>],
    /// The basis of the check of each lesson.
    pub bases: &'a [Basis],
    /// All reported findings, of lessons and of models.
    pub findings: &'a [Finding],
    /// The suppressed findings.
    pub allowed: &'a [SuppressedFinding],
    /// The claims of the course.
    pub ledger: &'a Ledger,
    /// The files with findings.
    pub sources: &'a [&'a SourceFile],
    /// The summary in one line.
    pub summary: &'a str,
}
