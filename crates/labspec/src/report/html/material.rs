//! What a page is made of.

use crate::check::{Allowed, Basis, Checked, Drawn};
use crate::finding::Finding;
use crate::ledger::Ledger;
use crate::source::SourceFile;

/// What a page is made of.
#[derive(Clone, Copy, Debug)]
pub struct Material<'a> {
    /// The lessons, in order.
    pub lessons: &'a [Checked],
    /// What the labs of each of them show in the runs of its claims.
    pub curves: &'a [Vec<Drawn>],
    /// What the check of each of them rests on.
    pub bases: &'a [Basis],
    /// All reported findings, of lessons and of models.
    pub findings: &'a [Finding],
    /// What the lessons allow.
    pub allowed: &'a [Allowed],
    /// The claims of the course.
    pub ledger: &'a Ledger,
    /// The files that findings lie in.
    pub sources: &'a [&'a SourceFile],
    /// What it all comes to, in one line.
    pub summary: &'a str,
}
