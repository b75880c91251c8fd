//! `labspec fmt`.

use super::collect::{Collected, collect};
use super::common::{CommandOutcome, Failure, ModelOptions, interrupted};
use super::file_check::is_other_json;
use super::output::write_file;
use super::output_kind::OutputKind;
use super::stdio::print;
use super::target::model_folder;
use labspec::bind::scene::Models;
use labspec::format::{MeaningChanged, format_checked};
use labspec::lint::load_lesson_at;
use labspec::report::{counted, printable_path};
use labspec::source::{SourceFile, Sources};
use std::path::{Path, PathBuf};

/// Arguments of `fmt`.
#[derive(clap::Args, Debug)]
pub(super) struct FmtArguments {
    /// Lessons (.md), labs and quizzes (.json), or folders of them
    #[arg(required = true, value_name = "PATH")]
    paths: Vec<PathBuf>,
    #[command(flatten)]
    models: ModelOptions,
    /// Also replace bare indexes by names: data.qpos[9] as data.joint('light').qpos[2]
    #[arg(long)]
    modernize: bool,
    /// Change nothing; list the files that would change
    #[arg(long)]
    check: bool,
}

pub(super) fn fmt(a: &FmtArguments) -> Result<CommandOutcome, Failure> {
    let mut outcome = CommandOutcome::Clean;
    let mut failures: Vec<String> = Vec::new();
    let collected = collect(&a.paths);
    collected.print_skipped();
    let Collected { files, problems, skipped } = collected;
    if files.is_empty() && problems.is_empty() {
        let names: Vec<String> = a.paths.iter().map(|path| printable_path(path).to_string()).collect();
        return Err(format!(
            "there is nothing to format in {}: no lesson and no JSON file",
            names.join(", ")
        ));
    }
    if !skipped.is_empty() {
        outcome = CommandOutcome::Partial;
    }
    failures.extend(problems.into_iter().map(|(_, why)| why));
    for (path, named) in files {
        if interrupted() {
            break;
        }
        match one(a, &path, named) {
            Ok(None) => {}
            Ok(Some(text)) => {
                if a.check {
                    outcome = CommandOutcome::Findings;
                }
                print(&format!("{}: {text}\n", printable_path(&path)))?;
            }
            // A file that cannot be read or written does not affect the others.
            Err(failure) => failures.push(failure),
        }
    }
    if failures.is_empty() { Ok(outcome) } else { Err(failures.join("\nlabspec: ")) }
}

/// Formats one file; returns a message for the user, if there is one.
fn one(a: &FmtArguments, path: &Path, named: bool) -> Result<Option<String>, Failure> {
    let file = SourceFile::read(path)?;
    let folder = model_folder(&a.models, path)?;
    let lesson = load_lesson_at(file, path, &Sources::Disk, &folder);
    if !named && is_other_json(&lesson) {
        return Ok(None);
    }
    let mut models = Models::new(folder.clone());
    // The formatted text is parsed again before the file is replaced.
    let done =
        format_checked(&lesson, &folder, a.modernize.then_some(&mut models)).map_err(|MeaningChanged| {
            format!(
                "{} is unchanged: formatting would change its meaning; please report this lesson",
                printable_path(path)
            )
        })?;
    let unread = (!lesson.broken.is_empty()).then(|| {
        let (path, blocks) = (printable_path(path), counted(lesson.broken.len(), "block"));
        format!(
            "{blocks} of {path} cannot be read, and may be laid out wrongly; `labspec check {path}` says why"
        )
    });
    if done.edits.is_empty() {
        return unread.map_or(Ok(None), Err);
    }
    let texts = (done.changed > 0).then(|| format!("{} of {} texts", done.changed, done.total));
    let blocks = (done.laid_out > 0).then(|| format!("the layout of {}", counted(done.laid_out, "block")));
    let checked_texts = texts.into_iter().chain(blocks).collect::<Vec<_>>().join(" and ");
    let verb = if a.check { "would change" } else { "changed" };
    if !a.check {
        write_file(path, OutputKind::Lesson(lesson.file.text()), &done.text)?;
    }
    let message = format!("{checked_texts} {verb}");
    match unread {
        None => Ok(Some(message)),
        Some(unread) => Err(format!("{}: {message}; {unread}", printable_path(path))),
    }
}
