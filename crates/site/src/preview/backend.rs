//! What the program does for the server.

use labspec::check::{CheckLevel, Checked};
use labspec::finding::Finding;
use labspec::ledger::Ledger;
use labspec::lint::ModelFolder;
use labspec::spec::Lesson;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// The size and the time of each file of a course; `None` for one that does not exist.
pub type Fingerprint = BTreeMap<PathBuf, Option<(u64, SystemTime)>>;

/// The results of a check.
#[derive(Debug, Default)]
pub struct CourseCheck {
    /// The lessons, in order.
    pub lessons: Vec<Checked>,
    /// All findings, of lessons and of other files.
    pub findings: Vec<Finding>,
    /// Every claim with its state.
    pub ledger: Ledger,
    /// The files on which the results depend.
    pub dependencies: BTreeSet<PathBuf>,
}

/// A `verify` object that a block could have.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VerifyProposal {
    /// `quiz drop, question 2`, `lab #1`.
    pub name: String,
    /// Bytes of its lab or question.
    pub span: Range<usize>,
    /// The object as text; empty where there is none.
    pub text: String,
    /// What the runs say about it.
    pub note: String,
    /// The lesson with the object; `None` where nothing can be inserted.
    pub lesson: Option<String>,
}

/// What the runs of a lesson suggest.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Proposals {
    /// `verify` objects.
    pub verify: Vec<VerifyProposal>,
    /// Numbers of the text, by their bytes, with where they come from.
    pub numbers: Vec<(Range<usize>, String)>,
}

/// What the program does for the server. Every error is a sentence for the author.
pub trait Backend: Sync {
    /// Checks the course.
    ///
    /// # Errors
    /// There is nothing to check, or settings cannot be read.
    fn check(&self, level: CheckLevel) -> Result<CourseCheck, String>;
    /// The folder of models of a lesson.
    fn models(&self, lesson: &Path) -> ModelFolder;
    /// The current state of the files of the course, and of others.
    fn fingerprint(&self, others: &BTreeSet<PathBuf>) -> Fingerprint;
    /// Applies the fix of one finding, as `check --fix` does.
    ///
    /// # Errors
    /// The file has another text than the lesson, or the fix makes nothing better.
    fn fix(&self, path: &Path, lesson: &Lesson, finding: &Finding) -> Result<(), String>;
    /// Replaces the text of a lesson.
    ///
    /// # Errors
    /// The file has another text than `old`, or cannot be written.
    fn write(&self, path: &Path, old: &str, new: &str) -> Result<(), String>;
    /// Runs the labs of a lesson for proposals.
    fn propose(&self, path: &Path, lesson: &Lesson) -> Proposals;
}
