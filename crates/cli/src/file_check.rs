//! The check of one file: the task and the outcome.

use super::cache::Cache;
use super::collect::ListedFile;
use super::common::{Failure, interrupted};
use super::course::{CheckRequest, CrossCheckRequest, SuppressedFindings};
use super::digest;
use super::policy::Policy;
use super::target::{model_folder_within, root};
use labspec::bind::parts::Hash;
use labspec::bind::scene::{Models, check_model_file};
use labspec::check::{self, Basis, CheckLevel, Checked, CrossCheck, LabOutcome, VerifyCurves};
use labspec::finding::Finding;
use labspec::lint::{self, ModelFolder, load_lesson_at, load_lesson_file};
use labspec::report::printable_path;
use labspec::rules;
use labspec::source::{SourceFile, Sources, read_text};
use labspec::spec::{FileKind, Lesson, kind_of};
use labspec::threads;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The task for a file.
pub(super) enum FileTask {
    /// Check the lesson with the models of this index.
    CheckLesson(usize),
    /// Check the model. The files that it includes are below this folder.
    CheckModel(PathBuf),
    /// Do not check the file, for this reason.
    Refuse(String),
}

/// The outcome of a file.
pub(super) enum FileOutcome {
    Lesson(Box<LessonOutcome>),
    /// JSON or XML of another program.
    Other,
    Model {
        loads: bool,
        findings: Vec<Finding>,
        sources: Vec<SourceFile>,
    },
    /// The file could not be read.
    Refused(String),
    /// Ctrl-C was pressed before it was checked.
    Interrupted,
}

/// The outcome of a lesson.
pub(super) struct LessonOutcome {
    pub(super) checked: Checked,
    pub(super) suppressed: SuppressedFindings,
    pub(super) basis: Basis,
    pub(super) curves: Vec<VerifyCurves>,
    pub(super) cross_check: CrossCheck,
    /// Whether a panic ended the check.
    pub(super) cancelled: bool,
}

/// Returns the task of each file, and the models that the lessons share, with each folder of models once.
///
/// # Errors
/// A folder of models cannot be read.
pub(super) fn plan_tasks(
    request: &CheckRequest<'_>,
    files: &[ListedFile],
    hash: Hash,
) -> Result<(Vec<FileTask>, Vec<Models>), Failure> {
    let mut tasks = Vec::new();
    // Lessons of one folder share a folder of models, which is searched and listed once.
    let mut name_by_lesson_folder: BTreeMap<PathBuf, String> = BTreeMap::new();
    let mut folders: BTreeMap<String, ModelFolder> = BTreeMap::new();
    let mut lessons = Vec::new();
    for (path, _) in files {
        let task = match kind_of(path) {
            FileKind::Lesson | FileKind::Json => {
                let lesson_folder = lint::lesson_folder(path);
                let name = match name_by_lesson_folder.get(&lesson_folder) {
                    Some(name) => name.clone(),
                    None => {
                        let folder = model_folder_within(request.models, path, request.paths)?;
                        let name = format!("{folder:?}");
                        folders.insert(name.clone(), folder);
                        name_by_lesson_folder.insert(lesson_folder, name.clone());
                        name
                    }
                };
                lessons.push((tasks.len(), name));
                FileTask::CheckLesson(0)
            }
            FileKind::Model => FileTask::CheckModel(root(request.models, &lint::lesson_folder(path), &[])?),
            FileKind::Unknown => FileTask::Refuse(format!(
                "{} is not a lesson: lessons are Markdown (.md, .markdown, .mdx, .qmd, .Rmd) or JSON, models are .xml",
                printable_path(path)
            )),
        };
        tasks.push(task);
    }
    let numbers: BTreeMap<&String, usize> = folders.keys().zip(0..).collect();
    for (i, name) in &lessons {
        if let (Some(task), Some(number)) = (tasks.get_mut(*i), numbers.get(name)) {
            *task = FileTask::CheckLesson(*number);
        }
    }
    Ok((tasks, folders.into_values().map(|folder| Models::with_hash(folder, hash)).collect()))
}

/// Checks one file. A panic ends only the check of this file.
pub(super) fn check_file(
    request: &CheckRequest<'_>,
    cache: &Cache,
    task: &FileTask,
    policy: &Policy,
    file: &ListedFile,
    models: &[Models],
) -> FileOutcome {
    let check = || {
        if interrupted() {
            return FileOutcome::Interrupted;
        }
        let (path, named) = file;
        match task {
            FileTask::Refuse(why) => FileOutcome::Refused(why.clone()),
            FileTask::CheckModel(_) if !named && is_other_xml(path) => FileOutcome::Other,
            FileTask::CheckModel(root) => {
                let (model, findings, sources) = check_model_file(path, Some(root));
                FileOutcome::Model { loads: model.is_some(), findings, sources }
            }
            FileTask::CheckLesson(number) => match models.get(*number) {
                Some(models) => check_lesson(request, cache, (path, *named), policy, models),
                None => FileOutcome::Other,
            },
        }
    };
    threads::catch_panic(check).unwrap_or_else(|panic| FileOutcome::Refused(panic_message(&panic)))
}

/// Loads a lesson, runs its labs and checks its claims.
fn check_lesson(
    request: &CheckRequest<'_>,
    cache: &Cache,
    (path, named): (&Path, bool),
    policy: &Policy,
    models: &Models,
) -> FileOutcome {
    let lesson = match read_lesson(request, path, models) {
        Ok(lesson) => Lesson { conventions: policy.conventions.clone(), ..lesson },
        Err(why) => return FileOutcome::Refused(why),
    };
    if !named && is_other_json(&lesson) {
        return FileOutcome::Other;
    }
    let checked =
        threads::catch_panic(|| cache.check_cached(path, &lesson, models, request.level, interrupted));
    let mut outcome = match checked {
        Ok(outcome) => outcome,
        Err(panic) => return FileOutcome::Lesson(Box::new(cancelled_lesson(lesson, &panic))),
    };
    let listings = request.listings.map_or_else(Vec::new, |runner| {
        runner.check_lesson(&lesson, &policy.listings, &mut outcome.findings)
    });
    let printed = check::claim_printed_numbers(&lesson, &listings, &mut outcome);
    // Runs may have been incomplete, and an incomplete check has no result.
    if interrupted() {
        return FileOutcome::Interrupted;
    }
    let basis = match request.with_bases {
        true => check::basis(&lesson, models, digest::hex_of),
        false => Basis::default(),
    };
    let CrossCheckRequest { collect_runs, recording } = request.cross_check;
    let cross_check = match collect_runs || recording.is_some() {
        true => check::cross_check(&lesson, models, digest::hex_of, recording, &mut outcome.findings),
        false => CrossCheck::default(),
    };
    if interrupted() {
        return FileOutcome::Interrupted;
    }
    let curves = if request.with_curves { check::curves(&lesson, models) } else { Vec::new() };
    let checked = Checked { listings, printed, ..check::join(lesson, outcome, request.level) };
    let suppressed = SuppressedFindings::default();
    FileOutcome::Lesson(Box::new(LessonOutcome {
        checked,
        suppressed,
        basis,
        curves,
        cross_check,
        cancelled: false,
    }))
}

/// Reads a lesson from its file, or from standard input if the path denotes it.
fn read_lesson(request: &CheckRequest<'_>, path: &Path, models: &Models) -> Result<Lesson, String> {
    match request.stdin.filter(|(name, _)| name == path) {
        Some((name, text)) => {
            let file = SourceFile::new(name.display().to_string(), text.as_str());
            Ok(load_lesson_at(file, name, &Sources::Disk, models.folder()))
        }
        None => load_lesson_file(path, models.folder()),
    }
}

/// The outcome of a lesson whose check ended with a panic: the panic is reported in addition to the findings of its structure.
fn cancelled_lesson(lesson: Lesson, panic: &str) -> LessonOutcome {
    let finding = Finding::error(rules::UNREADABLE_FILE, 0..0, panic_message(panic))
        .why("no lab of this lesson was run to its end, and no claim was checked")
        .help("report it with this lesson; the other lessons were checked");
    LessonOutcome {
        checked: check::join(lesson, LabOutcome::from_finding(finding), CheckLevel::STATIC),
        suppressed: SuppressedFindings::default(),
        basis: Basis::default(),
        curves: Vec::new(),
        cross_check: CrossCheck::default(),
        cancelled: true,
    }
}

/// The message of a panic that ended the check of a file.
fn panic_message(panic: &str) -> String {
    format!("labspec failed while checking this file: {panic}")
}

/// The maximum size of XML that is searched for a model, in bytes.
const MAX_XML: u64 = 64 << 20;

/// Whether the file is XML of another program, or a part that models include.
fn is_other_xml(path: &Path) -> bool {
    let is_root = |text: &str| {
        text.split("<mujoco").skip(1).any(|rest| !rest.starts_with(|c: char| c.is_alphanumeric()))
    };
    // What cannot be read as text is left to the check, which reports it.
    read_text(path, MAX_XML, "the XML").is_ok_and(|text| !is_root(&text))
}

/// Whether the file is JSON of another program, which may be in a folder of lessons. A file that the user
/// named is always checked.
pub(super) fn is_other_json(lesson: &Lesson) -> bool {
    lesson.findings.iter().any(|f| f.code == "unknown-spec")
}
