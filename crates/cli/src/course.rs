//! The request and the results of the check of all files.

use super::baseline::Baseline;
use super::common::ModelOptions;
use super::listings::ListingRunner;
use super::policy::{Policy, PolicyOptions};
use labspec::check::{
    Basis, CheckLevel, Checked, CrossCheck, ReferenceRecording, SuppressedFinding, VerifyCurves,
};
use labspec::finding::Finding;
use labspec::ledger::Ledger;
use labspec::source::SourceFile;
use std::collections::BTreeSet;
use std::path::PathBuf;

/// The files to check, and the options of the check.
pub(super) struct CheckRequest<'a> {
    pub(super) paths: &'a [PathBuf],
    /// Whether named files without a lab, a quiz or a model are skipped, as in folders.
    pub(super) skip_others: bool,
    /// The name and the text of a lesson from standard input.
    pub(super) stdin: Option<&'a (PathBuf, String)>,
    pub(super) models: &'a ModelOptions,
    pub(super) level: CheckLevel,
    /// Which findings are reported, and with which severity.
    pub(super) policy: &'a PolicyOptions,
    /// Known findings, which are not reported again.
    pub(super) baseline: Option<&'a Baseline>,
    /// Runs the listings of lessons, if requested.
    pub(super) listings: Option<&'a ListingRunner<'a>>,
    /// Whether the basis of every verdict is collected.
    pub(super) with_bases: bool,
    pub(super) cross_check: CrossCheckRequest<'a>,
    /// Whether the plots of the runs of the claims are collected.
    pub(super) with_curves: bool,
    /// The maximum number of threads.
    pub(super) jobs: usize,
    /// Whether the name of a file is displayed while the file is checked.
    pub(super) progress: bool,
    /// If set, the findings of a lesson are printed as soon as it and all lessons before it are checked;
    /// the flag enables colours.
    pub(super) findings_in_color: Option<bool>,
}

/// The options of a comparison with the reference simulator.
#[derive(Clone, Copy, Default)]
pub(super) struct CrossCheckRequest<'a> {
    /// Whether the runs that it must perform are collected.
    pub(super) collect_runs: bool,
    /// Its recording.
    pub(super) recording: Option<&'a ReferenceRecording>,
}

/// The checked files and the results.
#[derive(Default)]
pub(super) struct CourseResults {
    pub(super) checked: Vec<Checked>,
    /// The basis of the verdicts of each lesson, if requested.
    pub(super) bases: Vec<Basis>,
    /// The comparison with the reference simulator for each lesson.
    pub(super) cross_checks: Vec<CrossCheck>,
    /// The name of the reference simulator, if there is a recording.
    pub(super) reference_engine: Option<String>,
    /// The plots of the runs of each lesson's claims, if requested.
    pub(super) curves: Vec<Vec<VerifyCurves>>,
    /// All findings.
    pub(super) findings: Vec<Finding>,
    /// Findings that require all lessons: about models, and about several lessons together.
    pub(super) course_findings: Vec<Finding>,
    pub(super) ledger: Ledger,
    pub(super) suppressed: SuppressedFindings,
    /// Files with findings, in addition to the lessons.
    pub(super) sources: Vec<SourceFile>,
    /// The number of files that were checked before Ctrl-C, and the number of all; `None` without Ctrl-C.
    pub(super) checked_before_interrupt: Option<(usize, usize)>,
    /// All files on which the results depend, and the folders of models.
    pub(super) dependencies: BTreeSet<PathBuf>,
}

/// Findings that are not reported: ignored by the user, suppressed by the author, or in the baseline.
#[derive(Default)]
pub(super) struct SuppressedFindings {
    pub(super) ignored: Vec<Finding>,
    pub(super) allowed: Vec<SuppressedFinding>,
    pub(super) baselined: Vec<Finding>,
}

impl SuppressedFindings {
    /// Moves those findings of a file here that the policy ignores or the baseline contains.
    pub(super) fn suppress(
        &mut self,
        policy: &Policy,
        baseline: Option<&Baseline>,
        findings: &mut Vec<Finding>,
        files: &[&SourceFile],
    ) {
        self.ignored.extend(policy.apply(findings));
        if let Some(baseline) = baseline {
            self.baselined.extend(baseline.apply(findings, files));
        }
    }

    /// Adds the suppressed findings of a file.
    pub(super) fn append(&mut self, more: SuppressedFindings) {
        self.ignored.extend(more.ignored);
        self.allowed.extend(more.allowed);
        self.baselined.extend(more.baselined);
    }
}
