//! Snapshots: the displayed values of the labs of a lesson, stored beside it in a text that people review, and compared
//! with the current values.

mod compare;
mod digits;
mod file;
mod picture;
mod runs;

pub use compare::Divergence;

use super::{CheckLevel, PreparedLab};
use crate::bind::scene::Models;
use crate::finding::Finding;
use crate::ledger::{Evidence, State};
use crate::printable::{printable, printable_path};
use crate::rules;
use crate::run::{Budget, StepVariant};
use crate::source::SourceFile;
use crate::spec::{Lab, Lesson};
use crate::verify::{HALVED, PERTURBED_BACK, PERTURBED_START, significant};
use compare::SnapshotDifference;
use file::{SnapshotFault, StoredLab};
use runs::{LabRuns, SnapshotRun};
use serde::{Deserialize, Serialize};
use std::ops::Range;
use std::path::Path;

/// The result of the snapshot of one lab.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SnapshotResult {
    /// Its address: `#1`.
    pub lab: String,
    /// Bytes of the lesson; empty for a removed lab.
    pub span: Range<usize>,
    /// Whether it equals the stored values.
    pub state: State,
    /// The changes of the lab, one clause each: a control, a trace, a setting.
    pub changes: Vec<String>,
    /// The first value that differs.
    pub divergence: Option<Divergence>,
    /// Number of traces and readouts that differ, over all runs.
    pub rows: usize,
    /// Why it could not be checked; empty otherwise.
    pub reason: String,
}

impl SnapshotResult {
    /// The result in one or two words.
    pub fn word(&self) -> &'static str {
        match self.state {
            State::True(_) => "as stored",
            State::Skipped => "left out",
            State::NotClaimed => "no values",
            State::False if self.divergence.is_some() => "differs",
            State::False => "changed",
            _ => "unchecked",
        }
    }

    /// Why it differs, in one line.
    pub fn remark(&self) -> String {
        let first = self.divergence.as_ref().map(|d| {
            let more = match self.rows {
                0 | 1 => String::new(),
                2 => ", and 1 more row".into(),
                n => format!(", and {} more rows", n - 1),
            };
            format!("\"{}\" {} from t = {} s on{more}", printable(&d.trace), d.run, significant(d.time))
        });
        let reason = Some(self.reason.clone()).filter(|r| !r.is_empty());
        reason.into_iter().chain(first).chain(self.changes.iter().cloned()).collect::<Vec<_>>().join("; ")
    }

    /// The lines printed below it: the first value that differs, and both curves.
    pub fn lines(&self) -> Vec<String> {
        let Some(d) = &self.divergence else { return Vec::new() };
        let within = d.tolerance.map_or(String::new(), |t| format!(" (± {})", significant(t)));
        let head = format!("stored {}{within} in line {}, now {}", d.stored, d.line, d.current);
        std::iter::once(head).chain(d.picture.iter().cloned()).collect()
    }
}

/// The snapshot of a lesson as it would be written now, and the stored one.
#[derive(Clone, Debug)]
pub struct SnapshotUpdate {
    /// The result for each lab, including labs that are not stored.
    pub labs: Vec<UpdatedLab>,
    /// The error in the stored file.
    pub fault: Option<String>,
    /// Whether a file exists.
    pub stored: bool,
    name: String,
}

/// A lab in a renewal.
#[derive(Clone, Debug)]
pub struct UpdatedLab {
    /// The result.
    pub result: SnapshotResult,
    /// Its lines in the file, if it is stored.
    pub old: Option<String>,
    /// Its lines as they would be written now; `None` for a lab that was removed or cannot run.
    pub new: Option<String>,
    /// Which of its runs are missing, or cut short; `None` if there are none.
    pub incomplete: Option<String>,
}

impl SnapshotUpdate {
    /// The text of a file with the new lines of each lab that is `accepted`, and the old lines of the others; `None` when
    /// no lab has lines.
    pub fn text(&self, accepted: impl Fn(&UpdatedLab) -> bool) -> Option<String> {
        let lines = |lab: &'_ UpdatedLab| match &lab.new {
            Some(new) if accepted(lab) => Some(new.clone()),
            // A removed lab is deleted; a lab that cannot run keeps its stored lines.
            None if accepted(lab) && lab.result.state == State::False => None,
            _ => lab.old.clone(),
        };
        let labs: Vec<String> = self.labs.iter().filter_map(lines).collect();
        (!labs.is_empty()).then(|| file::whole(&self.name, labs.iter().map(String::as_str)))
    }
}

/// The stored labs of a lesson, if it has any.
fn stored(lesson: &Lesson) -> Option<Result<Vec<StoredLab>, String>> {
    let file = match lesson.snapshot.as_ref()? {
        Ok(file) => file,
        Err(message) => return Some(Err(message.clone())),
    };
    let fault = |f: SnapshotFault| format!("{}:{}:{}: {}", name_of(file), f.line, f.column, f.message);
    Some(file::read(file).map_err(fault))
}

/// The name of a file without its folder.
fn name_of(file: &SourceFile) -> String {
    let path = Path::new(&**file.path());
    path.file_name().map_or(String::new(), |name| printable_path(Path::new(name)))
}

/// Compares every lab of a lesson with its snapshot. Without a stored snapshot, nothing is claimed.
pub(super) fn check_snapshots(
    lesson: &Lesson,
    ready: &[PreparedLab<'_>],
    level: CheckLevel,
    findings: &mut Vec<Finding>,
) -> Vec<SnapshotResult> {
    let Some(stored) = stored(lesson) else { return Vec::new() };
    let all = |state: State, reason: &str| {
        let with_state = |(address, lab): (_, &Lab)| SnapshotResult {
            state,
            reason: reason.into(),
            ..unchecked(&address, lab)
        };
        lesson.addressed().into_iter().map(with_state).collect::<Vec<_>>()
    };
    if !level.labs {
        return if level.claims { Vec::new() } else { all(State::Skipped, "") };
    }
    let labs = match stored {
        Ok(labs) => labs,
        Err(message) => {
            let help = "restore the file, or write it again: labspec snapshot --accept";
            findings.push(Finding::new(rules::SNAPSHOT_UNREADABLE, 0..0, message).help(help));
            return all(State::Unchecked, "its snapshot cannot be read");
        }
    };
    let lab_runs = runs::run_labs(lesson, ready);
    let mut list: Vec<SnapshotResult> =
        lab_runs.iter().map(|lab| compare_lab(lab, &labs, lesson, findings)).collect();
    for result in removed_labs(&labs, &lab_runs) {
        let message = format!("the snapshot has the lab {}, but the lesson does not", printable(&result.lab));
        findings.push(outdated(0..0, message, lesson));
        list.push(result);
    }
    list
}

fn unchecked(address: &crate::spec::LabAddress, lab: &Lab) -> SnapshotResult {
    SnapshotResult {
        lab: address.to_string(),
        span: lab.span.clone(),
        state: State::Unchecked,
        changes: Vec::new(),
        divergence: None,
        rows: 0,
        reason: String::new(),
    }
}

/// The stored labs that are no longer in the lesson.
fn removed_labs<'a>(
    labs: &'a [StoredLab],
    lab_runs: &'a [LabRuns<'_, '_>],
) -> impl Iterator<Item = SnapshotResult> + 'a {
    let is_gone =
        |lab: &&StoredLab| lab_runs.iter().all(|current| current.address.to_string() != lab.address);
    labs.iter().filter(is_gone).map(|lab| SnapshotResult {
        lab: lab.address.clone(),
        span: 0..0,
        state: State::False,
        changes: vec!["the lab is no longer in the lesson".into()],
        divergence: None,
        rows: 0,
        reason: String::new(),
    })
}

/// Compares one lab with its stored values.
fn compare_lab(
    current: &LabRuns<'_, '_>,
    labs: &[StoredLab],
    lesson: &Lesson,
    findings: &mut Vec<Finding>,
) -> SnapshotResult {
    let mut result = unchecked(&current.address, current.lab);
    if current.runs.is_empty() {
        (result.state, result.reason) = (State::Unchecked, "it cannot run".into());
        return result;
    }
    let place = current.lab.place();
    let Some(old) = labs.iter().find(|lab| lab.address == result.lab) else {
        (result.state, result.changes) = (State::False, vec!["the lab is not in the snapshot".into()]);
        let message = format!("the lab {} is not in the snapshot", printable(&result.lab));
        findings.push(outdated(place, message, lesson));
        return result;
    };
    let runs: Vec<&SnapshotRun> = current.runs.iter().map(|(_, run)| run).collect();
    let SnapshotDifference { changes, first, rows, compared } = compare::compare(old, &runs);
    let file = lesson.snapshot.as_ref().and_then(|s| s.as_ref().ok()).map_or(String::new(), name_of);
    if let Some((d, probe)) = &first {
        let message = format!(
            "\"{}\" differs from the snapshot: {} it is {} at t = {} s, but {file} has {}",
            printable(&d.trace),
            d.run,
            d.current,
            significant(d.time),
            printable(&d.stored)
        );
        let label = current
            .lab
            .traces()
            .map(|t| &t.label)
            .chain(current.lab.readouts.iter().map(|r| &r.label))
            .nth(*probe);
        let place = label.map_or(place.clone(), |label| label.span());
        let mut finding = Finding::new(rules::SNAPSHOT_DIFFERS, place, message).help(review(lesson));
        if !changes.is_empty() {
            finding = finding.why(format!("other changes: {}", changes.join("; ")));
        }
        findings.push(finding);
    } else if !changes.is_empty() {
        let message = format!("the lab differs from the snapshot: {}", changes.join("; "));
        findings.push(outdated(place, message, lesson));
    }
    let good = first.is_none() && changes.is_empty();
    (result.state, result.reason) = match good {
        false => (State::False, String::new()),
        true if compared == 0 => {
            (State::NotClaimed, "its snapshot has no value with a certain digit".to_string())
        }
        true if current.incomplete > 0 => (State::Skipped, not_compared(current)),
        true => (State::True(Evidence::Simulated), String::new()),
    };
    (result.changes, result.divergence, result.rows) = (changes, first.map(|(d, _)| d), rows);
    result
}

/// Which runs of a lab were not compared to their end.
fn not_compared(current: &LabRuns<'_, '_>) -> String {
    let all = current.runs.len().max(current.incomplete);
    format!("{} of at least {all} runs need more work than a file may take", current.incomplete)
}

fn outdated(place: Range<usize>, message: String, lesson: &Lesson) -> Finding {
    Finding::new(rules::SNAPSHOT_OUTDATED, place, message).help(review(lesson))
}

fn review(lesson: &Lesson) -> String {
    let path = printable(lesson.file.path());
    format!("fix the lab, or accept an intended change: labspec snapshot --review {path}")
}

/// The snapshot of a lesson as it would be written now, and the stored one.
pub fn update_snapshot(lesson: &Lesson, models: &Models) -> SnapshotUpdate {
    let mut ignored = Vec::new();
    let ready: Vec<PreparedLab<'_>> = lesson
        .all_labs()
        .into_iter()
        .filter_map(|lab| super::prepare(lab, models, CheckLevel::STATIC, &mut ignored))
        .collect();
    let (old, fault) = match stored(lesson) {
        None => (Vec::new(), None),
        Some(Ok(labs)) => (labs, None),
        Some(Err(fault)) => (Vec::new(), Some(fault)),
    };
    let lab_runs = runs::run_labs(lesson, &ready);
    let one = |current: &LabRuns<'_, '_>| {
        let result = compare_lab(current, &old, lesson, &mut Vec::new());
        let stored_text = old.iter().find(|lab| lab.address == result.lab).map(|lab| lab.text.clone());
        let incomplete = (current.incomplete > 0).then(|| not_compared(current));
        UpdatedLab { result, old: stored_text, new: current_lines(current), incomplete }
    };
    let mut labs: Vec<UpdatedLab> = lab_runs.iter().map(one).collect();
    let lost = removed_labs(&old, &lab_runs).map(|result| {
        let text = old.iter().find(|lab| lab.address == result.lab).map(|lab| lab.text.clone());
        UpdatedLab { result, old: text, new: None, incomplete: None }
    });
    labs.extend(lost);
    let name = Path::new(&**lesson.file.path())
        .file_name()
        .map_or(String::new(), |n| n.to_string_lossy().into_owned());
    SnapshotUpdate { labs, fault, stored: lesson.snapshot.is_some(), name }
}

/// The lines of a lab, with the digits that the numerics determine.
fn current_lines(current: &LabRuns<'_, '_>) -> Option<String> {
    let ready = current.ready.filter(|_| !current.runs.is_empty())?;
    let under = |numerics: StepVariant, input| {
        let budget = Budget { left: 3 * Budget::TRIAL.left };
        runs::play(ready, input, numerics, budget).ok().map(|(run, _)| run)
    };
    let runs: Vec<(SnapshotRun, Vec<SnapshotRun>)> = current
        .runs
        .iter()
        .map(|(input, run)| {
            let others =
                [HALVED, PERTURBED_START, PERTURBED_BACK].into_iter().filter_map(|n| under(n, input));
            (run.clone(), others.collect())
        })
        .collect();
    Some(file::lab(
        &current.address.to_string(),
        current.lab.title.as_ref().map_or("", |t| t.as_str()),
        &runs,
    ))
}
