//! The data that the parts of a lesson's page look up: the file, names, plots, and the ledger.

use super::text::Names;
use crate::check::{Basis, RunSettings, VerifyCurves};
use crate::ledger::{Entry, State, Subject};
use crate::spec::Lesson;
use crate::verify::RenderedText;
use std::collections::BTreeMap;
use std::ops::Range;

/// The data that the parts of a lesson's page look up.
pub(super) struct LessonContext<'a> {
    pub(super) lesson: &'a Lesson,
    pub(super) names: &'a Names,
    pub(super) curves: &'a [VerifyCurves],
    pub(super) rendered: RenderedText,
    pub(super) basis: Option<&'a Basis>,
    pub(super) entries: BTreeMap<(Subject, usize, usize), Vec<&'a Entry>>,
}

impl<'a> LessonContext<'a> {
    pub(super) fn line(&self, offset: usize) -> usize {
        self.lesson.file.position(offset).line
    }

    /// The runs of a claim, with the settings of each at its start.
    pub(super) fn runs(&self, claim: &str) -> Option<&'a [(String, Option<RunSettings>)]> {
        let basis = self.basis?.claims.iter().find(|basis| basis.name == claim)?;
        Some(&basis.runs)
    }

    /// The entry of the ledger about a claim.
    pub(super) fn entry(&self, subject: Subject, span: &Range<usize>, what: &str) -> Option<&'a Entry> {
        let all = self.entries.get(&(subject, span.start, span.end))?;
        all.iter().find(|e| e.what == what).or(all.first()).copied()
    }

    /// The state of a claim in the ledger, and the word for it.
    pub(super) fn state(
        &self,
        subject: Subject,
        span: &Range<usize>,
        what: &str,
    ) -> Option<(State, &'a str)> {
        self.entry(subject, span, what).map(|e| (e.state, e.word))
    }
}
