//! The ledger of a course: the claims of all lessons and models, adjusted for suppressed findings.

use super::baseline::Baseline;
use super::common::Failure;
use super::course::CourseResults;
use super::policy::Policies;
use super::widgets::{self, PageWidget};
use labspec::check;
use labspec::finding::{Finding, Severity};
use labspec::ledger::{Entry, Evidence, Ledger, State, Subject};
use labspec::report::Summary;
use labspec::spec::Lesson;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The information about files that the ledger needs in addition to the results.
#[derive(Default)]
pub(super) struct FileOutcomes {
    /// Lessons whose check ended with a panic.
    pub(super) cancelled: BTreeSet<Arc<str>>,
    /// Models that the user named, and whether they load.
    pub(super) models: Vec<(PathBuf, bool)>,
    /// Files that were skipped, with the reasons.
    pub(super) skipped: Vec<(PathBuf, String)>,
}

/// Builds the ledger of everything that was checked.
///
/// # Errors
/// The settings of a lesson cannot be read.
pub(super) fn build_ledger(
    results: &CourseResults,
    files: &FileOutcomes,
    policies: &mut Policies,
    baseline: Option<&Baseline>,
) -> Result<Ledger, Failure> {
    let mut ledger = check::ledger(&results.checked, &results.findings);
    ledger.break_off(|path| files.cancelled.contains(path));
    let mut of_files = Ledger::default();
    files.models.iter().for_each(|(path, loads)| of_files.add(model_entry(path, *loads)));
    files.skipped.iter().for_each(|(path, why)| of_files.add(skipped_entry(path, why.clone())));
    ledger.append(of_files);
    accept_page_widgets(&mut ledger, results, policies)?;
    keep_suppressed_failures(&mut ledger, results);
    if let Some(baseline) = baseline {
        let lessons: Vec<&Lesson> = results.checked.iter().map(|c| &c.lesson).collect();
        let unchecked = baseline.unchecked(ledger.entries(), &lessons);
        ledger.mark_baselined_at(&unchecked);
    }
    Ok(ledger)
}

/// Accepts the widgets of a lesson's page that its settings declare.
fn accept_page_widgets(
    ledger: &mut Ledger,
    results: &CourseResults,
    policies: &mut Policies,
) -> Result<(), Failure> {
    let mut of_pages: BTreeMap<Arc<str>, (&Lesson, Vec<PageWidget>)> = BTreeMap::new();
    for c in results.checked.iter().filter(|c| !c.lesson.widgets.is_empty()) {
        let path = c.lesson.file.path();
        of_pages.insert(path.clone(), (&c.lesson, policies.policy_for(Path::new(&**path))?.widgets));
    }
    ledger.accept_widgets(|path, span| {
        let (lesson, declared) = of_pages.get(path)?;
        widgets::state(lesson, span, declared)
    });
    Ok(())
}

/// A suppressed finding must not turn a failure into a success: a file with an ignored error counts as not checked, and a claim
/// whose findings are all in the baseline gets the state "baselined".
fn keep_suppressed_failures(ledger: &mut Ledger, results: &CourseResults) {
    let problems = |all: &[Finding]| {
        group_by_path(all.iter().filter(|f| f.severity != Severity::Note).cloned().collect())
    };
    let baselined = problems(&results.suppressed.baselined);
    let reported = problems(&results.findings);
    let concerns = |e: &Entry, findings: Option<&Vec<Finding>>| {
        findings.is_some_and(|all| all.iter().any(|f| is_about(f, e)))
    };
    ledger.mark_baselined(|e| concerns(e, baselined.get(&e.path)) && !concerns(e, reported.get(&e.path)));
    let ignored = results.suppressed.ignored.iter().filter(|f| f.is_error()).cloned().collect();
    for (path, all) in group_by_path(ignored) {
        ledger.add(skipped_entry(Path::new(&*path), format!("{} ignored", Summary::count(&all))));
    }
}

/// Whether a finding concerns the claim of an entry.
fn is_about(f: &Finding, e: &Entry) -> bool {
    let whole = e.span.is_empty();
    let inside = f.span.start <= e.span.end && e.span.start <= f.span.end;
    // A false claim has its own findings. A claim that was not evaluated fails because of the findings of its container.
    let is_claim = Subject::CLAIMS.contains(&e.subject);
    match &f.claim {
        Some(claim) if is_claim => check::is_about(claim, e),
        Some(_) => whole,
        None if is_claim => e.state == State::Unchecked && inside,
        None => whole || inside,
    }
}

/// Groups findings by the path of their file.
pub(super) fn group_by_path(findings: Vec<Finding>) -> BTreeMap<Arc<str>, Vec<Finding>> {
    let mut by_path: BTreeMap<Arc<str>, Vec<Finding>> = BTreeMap::new();
    for f in findings {
        by_path.entry(f.path.clone()).or_default().push(f);
    }
    by_path
}

/// The entry of a file that was not checked completely, with the reason.
fn skipped_entry(path: &Path, remark: String) -> Entry {
    let path: Arc<str> = Arc::from(path.display().to_string());
    Entry {
        subject: Subject::File,
        owner: path.to_string(),
        path,
        span: 0..0,
        state: State::Skipped,
        word: "left out",
        what: String::new(),
        remark,
    }
}

/// The entry of a model that the user named.
fn model_entry(path: &Path, loads: bool) -> Entry {
    let (state, word) =
        if loads { (State::True(Evidence::Computed), "loads") } else { (State::False, "refused") };
    let path: Arc<str> = Arc::from(path.display().to_string());
    Entry {
        subject: Subject::Model,
        owner: path.to_string(),
        path,
        span: 0..0,
        state,
        word,
        what: String::new(),
        remark: String::new(),
    }
}
