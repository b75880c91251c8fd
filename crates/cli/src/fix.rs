//! `labspec check --fix`: applies safe fixes. Every fix is verified before the file is written.
//!
//! [`labspec::repair`] decides which fixes are applied, and how they are verified. All other bytes of
//! the file remain unchanged.

use super::collect::collect;
use super::common::{Failure, interrupted};
use super::course::CheckRequest;
use super::file_check::is_other_json;
use super::output::write_file;
use super::output_kind::OutputKind;
use super::policy::Policies;
use super::stdio::print;
use super::target::model_folder_within;
use labspec::bind::scene::Models;
use labspec::check;
use labspec::lint::{load_lesson_file, reload_lesson};
use labspec::repair::{CheckedText, repair, traces};
use labspec::report::{printable, printable_path};
use labspec::spec::{FileKind, Lesson, kind_of};
use similar::TextDiff;
use std::path::Path;

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
    for (path, named) in collect(request.paths).files {
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
            let mut found = check::run_checks(&lesson, &models, request.level);
            if let Some(listings) = request.listings {
                let results = listings.check_lesson(&lesson, &policy.listings, &mut found.findings);
                check::claim_printed_numbers(&lesson, &results, &mut found);
            }
            let broken = lesson.broken.len();
            let checked = check::join(lesson, found, request.level);
            let mut findings = checked.findings;
            policy.apply(&mut findings);
            CheckedText { text: checked.lesson.file.text().to_string(), findings, broken }
        };
        let old = lesson.file.text().to_string();
        let first = lesson.clone();
        let again = |text: &str| look(reload_lesson(&first, text, models.folder()));
        let shows = |text: &str| traces(&reload_lesson(&first, text, models.folder()), &models);
        let (new, count) = repair(look(lesson), mode.guesses, &again, &shows);
        if count == 0 || interrupted() {
            continue;
        }
        repaired.fixes += count;
        repaired.files += 1;
        if mode.diff {
            print(&difference(&path, &old, &new))?;
        } else {
            write_file(&path, OutputKind::Lesson(&old), &new)?;
        }
    }
    Ok(repaired)
}

/// The changes of a file in the format of `diff -u`.
fn difference(path: &Path, old: &str, new: &str) -> String {
    let name = printable_path(path);
    let diff = TextDiff::from_lines(old, new);
    let text =
        diff.unified_diff().context_radius(3).header(&format!("a/{name}"), &format!("b/{name}")).to_string();
    text.split('\n').map(printable).collect::<Vec<_>>().join("\n")
}
