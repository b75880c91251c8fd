//! `labspec check --fix`: applies safe fixes. Every fix is verified before the file is written.
//!
//! [`labspec::repair`] decides which fixes are applied, and how they are verified. All other bytes of
//! the file remain unchanged.

use super::collect::{ListedFile, collect};
use super::common::{Failure, interrupted};
use super::course::CheckRequest;
use super::file_check::is_other_json;
use super::output::write_file;
use super::output_kind::OutputKind;
use super::policy::Policies;
use super::stdio::{print, print_error};
use super::target::model_folder_within;
use labspec::bind::scene::Models;
use labspec::check::{self, CheckLevel};
use labspec::finding::Finding;
use labspec::lint::{load_lesson_file, reload_lesson};
use labspec::repair::{CheckedText, repair, traces};
use labspec::report::{printable, printable_path};
use labspec::rules;
use labspec::source::SourceFile;
use labspec::spec::{FileKind, Lesson, kind_of};
use labspec_finding::Layer;
use similar::TextDiff;
use std::path::{Path, PathBuf};

/// The options of `--fix`.
#[derive(Clone, Copy, Debug)]
pub(super) struct FixMode {
    /// Whether fixes that are guesses are applied as well.
    pub(super) guesses: bool,
    /// Whether changes are only displayed.
    pub(super) diff: bool,
}

/// The number of applied fixes, and of changed files.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct AppliedFixes {
    pub(super) fixes: usize,
    pub(super) files: usize,
}

/// Applies fixes to all lessons.
///
/// # Errors
/// A file cannot be written. A file that cannot be read is left to the check.
pub(super) fn fix(request: &CheckRequest<'_>, mode: FixMode) -> Result<AppliedFixes, Failure> {
    let mut policies = Policies::new(request.policy)?;
    let mut repaired = AppliedFixes::default();
    let files = collect(request.paths).files;
    for (path, named) in files.iter().cloned() {
        if interrupted() {
            break;
        }
        if !matches!(kind_of(&path), FileKind::Lesson | FileKind::Json) {
            continue;
        }
        let folder = model_folder_within(request.models, &path, request.paths)?;
        let Ok(mut lesson) = load_lesson_file(&path, &folder) else { continue };
        if !named && is_other_json(&lesson) {
            continue;
        }
        let policy = policies.policy_for(&path)?;
        lesson.conventions = policy.conventions.clone();
        let models = Models::new(folder);
        let look = |lesson: Lesson| {
            // The runs and the claims decide whether a fix stays, whatever is reported.
            let mut found = check::run_checks(&lesson, &models, CheckLevel::FULL);
            if let Some(listings) = request.listings {
                let results = listings.check_lesson(&lesson, &policy.listings, &mut found.findings);
                check::claim_printed_numbers(&lesson, &results, &mut found);
            }
            let broken = lesson.broken.len();
            let checked = check::join(lesson, found, CheckLevel::FULL);
            let mut findings = checked.findings;
            let errors = findings.iter().filter(|f| f.is_error()).count();
            policy.apply(&mut findings);
            findings.retain(|f| request.level.labs || !is_of_runs(f));
            CheckedText { text: checked.lesson.file.text().to_string(), findings, errors, broken }
        };
        let old = lesson.file.text().to_string();
        let first = lesson.clone();
        let again = |text: &str| look(reload_lesson(&first, text, models.folder()));
        let shows = |text: &str| traces(&reload_lesson(&first, text, models.folder()), &models);
        let (new, count) = repair(look(lesson), mode.guesses, &again, &shows);
        if count == 0 || interrupted() {
            continue;
        }
        if mode.diff {
            print(&difference(&path, &old, &new))?;
        } else if !write_fixed(&path, &old, &new, &files, request)? {
            continue;
        }
        repaired.fixes += count;
        repaired.files += 1;
    }
    Ok(repaired)
}

/// Writes a fixed lesson; false if it is taken back, because a lesson that uses its labs would have more errors.
fn write_fixed(
    path: &Path,
    old: &str,
    new: &str,
    files: &[ListedFile],
    request: &CheckRequest<'_>,
) -> Result<bool, Failure> {
    let users = lessons_that_use(path, files);
    let before = errors_of(&users, request)?;
    write_file(path, OutputKind::Lesson(old), new)?;
    let after = errors_of(&users, request);
    // A check that was interrupted has not seen everything.
    let is_unchecked = interrupted() && !users.is_empty();
    if !is_unchecked && after.is_ok_and(|after| after <= before) {
        return Ok(true);
    }
    write_file(path, OutputKind::Lesson(new), old)?;
    print_error(&format!(
        "{} is unchanged: with its fixes, a lesson that uses its labs would have more errors, or could not be checked\n",
        printable_path(path)
    ));
    Ok(false)
}

/// The lessons whose text names a lab of another lesson: `deg.md#1`.
fn lessons_that_use(path: &Path, files: &[ListedFile]) -> Vec<PathBuf> {
    let Some(name) = path.file_name().map(|name| format!("{}#", name.to_string_lossy())) else {
        return Vec::new();
    };
    let is_user = |other: &&PathBuf| {
        let text = (*other != path).then(|| SourceFile::read(other).ok()).flatten();
        text.is_some_and(|file| file.text().contains(&name))
    };
    files.iter().map(|(other, _)| other).filter(is_user).cloned().collect()
}

/// The number of errors of some lessons.
fn errors_of(paths: &[PathBuf], request: &CheckRequest<'_>) -> Result<usize, Failure> {
    let mut errors = 0;
    for path in paths {
        let folder = model_folder_within(request.models, path, request.paths)?;
        let Ok(lesson) = load_lesson_file(path, &folder) else { continue };
        let found = check::run_checks(&lesson, &Models::new(folder), CheckLevel::FULL);
        let checked = check::join(lesson, found, CheckLevel::FULL);
        errors += checked.findings.iter().filter(|f| f.is_error()).count();
    }
    Ok(errors)
}

/// Whether a finding is one of runs or claims, which `--no-run` does not report.
fn is_of_runs(f: &Finding) -> bool {
    rules::find(f.code).is_some_and(|rule| matches!(rule.layer, Layer::Run | Layer::Claim))
}

/// The changes of a file in the format of `diff -u`.
fn difference(path: &Path, old: &str, new: &str) -> String {
    let name = printable_path(path);
    let diff = TextDiff::from_lines(old, new);
    let text =
        diff.unified_diff().context_radius(3).header(&format!("a/{name}"), &format!("b/{name}")).to_string();
    text.split('\n').map(printable).collect::<Vec<_>>().join("\n")
}
