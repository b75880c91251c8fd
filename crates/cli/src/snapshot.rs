//! `labspec snapshot`: the output of the labs of lessons, stored in files next to the lessons, and the review of changes.

use super::collect::{Collected, collect, orphaned_snapshots};
use super::common::{CommandOutcome, Failure, ModelOptions, interrupted};
use super::file_check::is_other_json;
use super::machine::{SnapshotRow, snapshot_row};
use super::output::{remove_file, write_file};
use super::output_kind::OutputKind;
use super::report_json::print_report;
use super::stdio::print;
use super::target::model_folder_within;
use clap::ValueEnum;
use labspec::bind::scene::Models;
use labspec::check::{self, SnapshotResult, SnapshotUpdate, UpdatedLab};
use labspec::ledger::State;
use labspec::lint::{ModelFolder, load_lesson_file, snapshot_path};
use labspec::report::counted;
use labspec::report::{printable, printable_path};
use labspec::spec::{FileKind, kind_of};
use schemars::JsonSchema;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::io::{BufRead, IsTerminal};
use std::path::PathBuf;

/// Arguments of `snapshot`.
#[derive(clap::Args, Debug)]
pub(super) struct SnapshotArguments {
    /// Lessons (.md), labs and quizzes (.json), or folders of lessons
    #[arg(required = true, value_name = "PATH")]
    paths: Vec<PathBuf>,
    #[command(flatten)]
    models: ModelOptions,
    /// Review the changes lab by lab; without a terminal, list them
    #[arg(long, conflicts_with = "accept")]
    review: bool,
    /// Store the current output, and remove snapshots of deleted lessons
    #[arg(long)]
    accept: bool,
    /// Output format
    #[arg(long, value_enum, default_value = "human")]
    format: SnapshotFormat,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum SnapshotFormat {
    /// For people
    Human,
    /// For programs
    Json,
}

/// The state of the snapshot of a lesson.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum SnapshotStatus {
    /// There is no stored snapshot.
    New,
    /// The output is as stored.
    Same,
    /// The output differs from the stored one.
    Changed,
    /// The stored snapshot cannot be read.
    Unreadable,
    /// The lesson does not exist any more.
    Gone,
}

impl SnapshotStatus {
    const ALL: [SnapshotStatus; 5] = [
        SnapshotStatus::New,
        SnapshotStatus::Same,
        SnapshotStatus::Changed,
        SnapshotStatus::Unreadable,
        SnapshotStatus::Gone,
    ];

    fn as_str(self) -> &'static str {
        match self {
            SnapshotStatus::New => "new",
            SnapshotStatus::Same => "same",
            SnapshotStatus::Changed => "changed",
            SnapshotStatus::Unreadable => "unreadable",
            SnapshotStatus::Gone => "gone",
        }
    }
}

/// A snapshot, and the actions on it.
struct ReviewedSnapshot {
    file: PathBuf,
    status: SnapshotStatus,
    renewal: Option<SnapshotUpdate>,
    /// Labs whose current output is accepted.
    accepted: BTreeSet<String>,
    written: bool,
}

pub(super) fn snapshot(a: &SnapshotArguments) -> Result<CommandOutcome, Failure> {
    let terminal = std::io::stdin().is_terminal() && std::io::stdout().is_terminal();
    let asks = a.review && a.format == SnapshotFormat::Human && terminal;
    let (mut all, has_skipped) = collect_lessons(a)?;
    for one in &mut all {
        if interrupted() {
            return Ok(CommandOutcome::Findings);
        }
        // A new snapshot overwrites nothing.
        let whole = a.accept || (one.status == SnapshotStatus::New && !a.review);
        if let Some(renewal) = one.renewal.as_ref().filter(|_| whole) {
            one.accepted = renewal.labs.iter().map(|lab| lab.result.lab.clone()).collect();
        }
    }
    if asks {
        let mut questions = std::io::stdin().lock();
        let mut say = |text: &str| print(text);
        review(&mut all, &mut questions, &mut say)?;
    }
    for one in &mut all {
        store(one, a.accept)?;
    }
    match a.format {
        SnapshotFormat::Human => print(&summary(&all, asks))?,
        SnapshotFormat::Json => print_report("snapshot", &machine(&all))?,
    }
    let open = |one: &ReviewedSnapshot| {
        remaining_changes(one).next().is_some() || (one.status == SnapshotStatus::Gone && !one.written)
    };
    let unread = |one: &ReviewedSnapshot| one.status == SnapshotStatus::Unreadable && !one.written;
    let bad = all.iter().any(|one| open(one) || unread(one));
    let in_part =
        all.iter().flat_map(|one| &one.renewal).flat_map(|r| &r.labs).any(|lab| lab.incomplete.is_some());
    Ok(match () {
        () if bad => CommandOutcome::Findings,
        () if in_part || has_skipped => CommandOutcome::Partial,
        () => CommandOutcome::Clean,
    })
}

/// Reads every lesson, runs its labs, and compares the output with the snapshots. Also returns whether a path was skipped.
fn collect_lessons(a: &SnapshotArguments) -> Result<(Vec<ReviewedSnapshot>, bool), Failure> {
    let collected = collect(&a.paths);
    collected.print_skipped();
    let Collected { files, problems, skipped } = collected;
    if let Some((_, why)) = problems.first() {
        return Err(why.clone());
    }
    let mut by_folder: BTreeMap<String, Models> = BTreeMap::new();
    let mut all = Vec::new();
    for (path, named) in &files {
        if interrupted() {
            break;
        }
        if !matches!(kind_of(path), FileKind::Lesson | FileKind::Json) {
            return Err(format!(
                "{} is not a lesson: name .md or .json files, or a folder of them",
                printable_path(path)
            ));
        }
        let folder: ModelFolder = model_folder_within(&a.models, path, &a.paths)?;
        let models = by_folder.entry(format!("{folder:?}")).or_insert_with(|| Models::new(folder));
        let lesson = load_lesson_file(path, models.folder())?;
        if !named && is_other_json(&lesson) || lesson.addressed().is_empty() && lesson.snapshot.is_none() {
            continue;
        }
        let renewal = check::update_snapshot(&lesson, models);
        let same = |lab: &UpdatedLab| is_same(lab);
        let status = match &renewal {
            r if r.fault.is_some() => SnapshotStatus::Unreadable,
            r if !r.stored => SnapshotStatus::New,
            r if r.labs.iter().all(same) => SnapshotStatus::Same,
            _ => SnapshotStatus::Changed,
        };
        let file = snapshot_path(path);
        all.push(ReviewedSnapshot {
            file,
            status,
            renewal: Some(renewal),
            accepted: BTreeSet::new(),
            written: false,
        });
    }
    for file in orphaned_snapshots(&a.paths) {
        let (status, accepted) = (SnapshotStatus::Gone, BTreeSet::new());
        all.push(ReviewedSnapshot { file, status, renewal: None, accepted, written: false });
    }
    if all.is_empty() {
        let names: Vec<String> = a.paths.iter().map(|p| printable_path(p)).collect();
        return Err(format!("{} has no lab", names.join(", ")));
    }
    Ok((all, !skipped.is_empty()))
}

/// Whether the output of a lab is as stored, as far as it was compared.
fn is_same(lab: &UpdatedLab) -> bool {
    matches!(lab.result.state, State::True(_) | State::NotClaimed | State::Skipped)
}

/// Labs whose output differs from the snapshot, or is not stored, even after this command.
fn remaining_changes(one: &ReviewedSnapshot) -> impl Iterator<Item = &UpdatedLab> {
    let labs = one.renewal.iter().flat_map(|r| &r.labs);
    labs.filter(|lab| {
        let can = lab.new.is_some() || lab.result.state == State::False;
        let done = can && one.accepted.contains(&lab.result.lab);
        !done && !is_same(lab)
    })
}

/// Asks for each lab with a different output whether the change is intended.
fn review(
    all: &mut [ReviewedSnapshot],
    answers: &mut impl BufRead,
    say: &mut impl FnMut(&str) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let total: usize = all.iter().map(|one| remaining_changes(one).count()).sum();
    let (mut number, mut rest) = (0, false);
    for one in all {
        let file = printable_path(&one.file);
        let open: Vec<UpdatedLab> = remaining_changes(one).cloned().collect();
        for lab in open {
            number += 1;
            let can = lab.new.is_some() || lab.result.state == State::False;
            say(&format!("\n{file} ({number} of {total})\n{}", describe_lab(&lab)))?;
            while can && !rest {
                say("accept it? y: yes, n: no, a: this and all that follow, q: leave the rest > ")?;
                let mut answer = String::new();
                let read =
                    answers.read_line(&mut answer).map_err(|e| format!("cannot read an answer: {e}"))?;
                match answer.trim().to_lowercase().as_str() {
                    "y" | "yes" => {
                        one.accepted.insert(lab.result.lab.clone());
                        break;
                    }
                    "n" | "no" => break,
                    "a" | "all" => rest = true,
                    "q" | "quit" => return Ok(()),
                    _ if read == 0 => return Ok(()),
                    _ => {}
                }
            }
            if can && rest {
                one.accepted.insert(lab.result.lab.clone());
            }
        }
    }
    Ok(())
}

/// Writes the accepted output.
fn store(one: &mut ReviewedSnapshot, everything: bool) -> Result<(), Failure> {
    let Some(renewal) = &one.renewal else {
        if everything {
            remove_file(&one.file, OutputKind::Snapshot)?;
            one.written = true;
        }
        return Ok(());
    };
    if one.accepted.is_empty() {
        return Ok(());
    }
    let Some(text) = renewal.text(|lab| one.accepted.contains(&lab.result.lab)) else { return Ok(()) };
    let old = std::fs::read_to_string(&one.file).ok();
    // Line breaks may have been converted by other tools.
    if old.is_none_or(|old| old.replace("\r\n", "\n") != text) {
        write_file(&one.file, OutputKind::Snapshot, &text)?;
        one.written = true;
    }
    Ok(())
}

/// The message about a lab whose output differs from the snapshot.
fn describe_lab(lab: &UpdatedLab) -> String {
    let snapshot = &lab.result;
    let mut text = format!(
        "  {:<10} lab {}: {}\n",
        snapshot.word(),
        printable(&snapshot.lab),
        printable(&snapshot.remark())
    );
    for line in snapshot.lines() {
        let _ = writeln!(text, "  {:<10}   {}", "", printable(&line));
    }
    text
}

/// The summary for people. Labs that were reviewed interactively are not repeated.
fn summary(all: &[ReviewedSnapshot], asked: bool) -> String {
    let mut text = String::new();
    let (mut same, mut open) = (0, 0);
    for one in all {
        let file = printable_path(&one.file);
        let fault = one.renewal.as_ref().and_then(|r| r.fault.as_deref()).unwrap_or_default();
        let labs = one.accepted.len();
        match (one.status, one.written) {
            (SnapshotStatus::Same, false) => same += 1,
            (SnapshotStatus::Gone, true) => _ = writeln!(text, "removed    {file}: its lesson is gone"),
            (SnapshotStatus::Gone, false) => {
                open += 1;
                _ = writeln!(text, "gone       {file}: its lesson does not exist");
            }
            (_, true) => _ = writeln!(text, "stored     {file}: {}", counted(labs, "lab")),
            (SnapshotStatus::Unreadable, false) => {
                open += 1;
                _ = writeln!(text, "unreadable {}", printable(fault));
            }
            (SnapshotStatus::New | SnapshotStatus::Changed, false) => {
                _ = writeln!(text, "{:<10} {file}", one.status.as_str());
            }
        }
        let listed = !(asked || one.status == SnapshotStatus::Unreadable);
        for lab in remaining_changes(one) {
            open += 1;
            if listed {
                text.push_str(&describe_lab(lab));
            }
        }
    }
    for lab in all.iter().flat_map(|one| &one.renewal).flat_map(|r| &r.labs) {
        if let Some(why) = &lab.incomplete {
            let _ = writeln!(text, "in part    lab {}: {why}", printable(&lab.result.lab));
        }
    }
    if same > 0 {
        let _ = writeln!(text, "as stored  {}", counted(same, "lesson"));
    }
    if open > 0 {
        text.push_str("labspec snapshot --review shows each change and asks; --accept accepts all of them\n");
    }
    text
}

/// The stored output of the labs of lessons, and whether it still matches.
#[derive(Serialize, JsonSchema)]
pub(super) struct SnapshotReport<'a> {
    /// Every snapshot that is there or could be.
    files: Vec<FileRow<'a>>,
}

/// The snapshot of a lesson.
#[derive(Serialize, JsonSchema)]
struct FileRow<'a> {
    /// Its path: that of the lesson, with `.snap` behind.
    file: String,
    /// The state of the file before the command: not stored, as stored, changed, unreadable, or without its lesson.
    #[schemars(extend("enum" = SnapshotStatus::ALL.map(SnapshotStatus::as_str)))]
    status: &'static str,
    /// It was written anew, or removed.
    written: bool,
    /// What is wrong with a file that cannot be read, with its place; null otherwise.
    fault: Option<&'a str>,
    /// The labs.
    labs: Vec<SnapshotLabRow<'a>>,
}

/// What became of the snapshot of a lab.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "lab")]
struct SnapshotLabRow<'a> {
    #[serde(flatten)]
    snapshot: SnapshotRow<'a>,
    /// It is stored as it is now.
    accepted: bool,
}

fn machine(all: &[ReviewedSnapshot]) -> SnapshotReport<'_> {
    let files = all.iter().map(|one| FileRow {
        file: one.file.display().to_string(),
        status: one.status.as_str(),
        written: one.written,
        fault: one.renewal.as_ref().and_then(|r| r.fault.as_deref()),
        labs: one.renewal.iter().flat_map(|r| &r.labs).map(|lab| lab_row(&lab.result, one)).collect(),
    });
    SnapshotReport { files: files.collect() }
}

fn lab_row<'a>(result: &'a SnapshotResult, one: &ReviewedSnapshot) -> SnapshotLabRow<'a> {
    SnapshotLabRow { snapshot: snapshot_row(result), accepted: one.accepted.contains(&result.lab) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use labspec::source::SourceFile;
    use labspec::spec::read_lesson;

    /// A lesson with three labs without stored output.
    fn reviewed_snapshot() -> ReviewedSnapshot {
        let lab = "```lab simlab\n{\"xml\": \"<mujoco/>\", \"stopAt\": 0.01, \"readouts\": [{\"label\": \"t\", \"expr\": \"data.time\"}]}\n```\n\n";
        let lesson = read_lesson(SourceFile::new("a.md", lab.repeat(3)));
        let renewal = check::update_snapshot(&lesson, &Models::new(ModelFolder::unknown()));
        let status = SnapshotStatus::Changed;
        ReviewedSnapshot {
            file: "a.md.snap".into(),
            status,
            renewal: Some(renewal),
            accepted: BTreeSet::new(),
            written: false,
        }
    }

    #[test]
    fn review_asks_about_each_lab() {
        for (answers, accepted, questions) in [
            ("y\nn\nyes\n", &["#1", "#3"][..], 3),
            ("what\nn\na\n", &["#2", "#3"], 3),
            ("n\nq\n", &[], 2),
            ("y\n", &["#1"], 2),
            ("a", &["#1", "#2", "#3"], 1),
        ] {
            let mut all = [reviewed_snapshot()];
            let mut printed = String::new();
            let mut say = |text: &str| {
                printed.push_str(text);
                Ok(())
            };
            review(&mut all, &mut answers.as_bytes(), &mut say).unwrap();
            assert_eq!(all[0].accepted.iter().collect::<Vec<_>>(), accepted, "{answers}");
            assert_eq!(printed.matches("accept it?").count(), questions, "{answers}: {printed}");
            assert!(
                printed.contains("a.md.snap (1 of 3)\n  changed    lab #1: the lab is not in the snapshot\n")
            );
        }
    }
}
