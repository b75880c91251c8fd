//! What is to be checked, and what the check of all files found: a request and its results.

use super::baseline::Baseline;
use super::common::ModelOptions;
use super::policy::{Policy, PolicyOptions};
use labspec::check::{Allowed, Basis, CheckLevel, Checked, CrossCheck, Drawn, Recording};
use labspec::finding::Finding;
use labspec::ledger::Ledger;
use labspec::source::SourceFile;
use std::collections::BTreeSet;
use std::path::PathBuf;

/// What is checked, and how.
pub(super) struct CheckRequest<'a> {
    pub(super) paths: &'a [PathBuf],
    /// A lesson from standard input: its name and its text.
    pub(super) stdin: Option<&'a (PathBuf, String)>,
    pub(super) models: &'a ModelOptions,
    pub(super) level: CheckLevel,
    /// Which findings are reported, and how severe they are.
    pub(super) policy: &'a PolicyOptions,
    /// Findings that are not reported again.
    pub(super) baseline: Option<&'a Baseline>,
    /// Whether the basis of every verdict is collected.
    pub(super) with_bases: bool,
    pub(super) cross_check: CrossCheckRequest<'a>,
    /// Whether the plots of the runs of the claims are collected.
    pub(super) with_curves: bool,
    /// Largest number of threads.
    pub(super) jobs: usize,
    /// Whether the name of a file is shown while the file is checked.
    pub(super) progress: bool,
    /// The findings of a lesson are printed as soon as it and all lessons before it are checked, with colours or without;
    /// `None` prints nothing.
    pub(super) findings_in_color: Option<bool>,
}

/// A comparison with the reference simulator.
#[derive(Clone, Copy, Default)]
pub(super) struct CrossCheckRequest<'a> {
    /// Whether the runs that it has to make are collected.
    pub(super) collect_runs: bool,
    /// What it recorded.
    pub(super) recording: Option<&'a Recording>,
}

/// Everything that was checked, and the results.
#[derive(Default)]
pub(super) struct CourseResults {
    pub(super) checked: Vec<Checked>,
    /// The basis of the verdicts of each lesson, where requested.
    pub(super) bases: Vec<Basis>,
    /// The comparison with the reference simulator for each lesson.
    pub(super) cross_checks: Vec<CrossCheck>,
    /// The name of the reference simulator, where there is a recording.
    pub(super) reference_engine: Option<String>,
    /// The plots of the runs of each lesson's claims, where requested.
    pub(super) curves: Vec<Vec<Drawn>>,
    /// All findings.
    pub(super) findings: Vec<Finding>,
    /// The findings that exist only once all lessons are checked: about models, and about several lessons together.
    pub(super) course_findings: Vec<Finding>,
    pub(super) ledger: Ledger,
    pub(super) suppressed: SuppressedFindings,
    /// Files with findings, besides the lessons.
    pub(super) sources: Vec<SourceFile>,
    /// Every file that the results depend on, and the folders of models.
    pub(super) dependencies: BTreeSet<PathBuf>,
}

/// Findings that are not reported: ignored by the user, suppressed by the author, or in the baseline.
#[derive(Default)]
pub(super) struct SuppressedFindings {
    pub(super) ignored: Vec<Finding>,
    pub(super) allowed: Vec<Allowed>,
    pub(super) baselined: Vec<Finding>,
}

impl SuppressedFindings {
    /// Moves the findings of a file here that the policy ignores and that the baseline holds.
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

    /// Adds those of a file.
    pub(super) fn append(&mut self, more: SuppressedFindings) {
        self.ignored.extend(more.ignored);
        self.allowed.extend(more.allowed);
        self.baselined.extend(more.baselined);
    }
}
