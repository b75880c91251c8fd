//! `labspec check` and `labspec verify`.

use super::stdio::{complain, print_json};
use super::target::{model_folder_within, root};
use super::{Color, Failure, ModelOptions, Outcome, interrupted, machine, print};
use crate::bind::scene::{Models, check_model_file};
use crate::check::{self, Checked, Depth};
use crate::finding::{self, Finding};
use crate::ledger::{self, Entry, Evidence, Ledger, State, Subject};
use crate::lint;
use crate::report::{self, Summary, printable, printable_path};
use crate::rules;
use crate::source::SourceFile;
use crate::spec::{FileKind, Lesson, kind_of, load_lesson_file};
use clap::ValueEnum;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Arguments of `check` and `verify`.
#[derive(clap::Args, Debug)]
pub(super) struct Arguments {
    /// Lessons (.md), labs and quizzes (.json), models (.xml), or folders of lessons
    #[arg(required = true, value_name = "PATH")]
    paths: Vec<PathBuf>,
    #[command(flatten)]
    models: ModelOptions,
    /// How to print
    #[arg(long, value_enum, default_value = "human")]
    format: Format,
    #[arg(long, value_enum, default_value = "auto", value_name = "WHEN")]
    color: Color,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Format {
    /// For people
    Human,
    /// For programs
    Json,
}

pub(super) fn check(a: &Arguments) -> Result<Outcome, Failure> {
    work(a, Depth { labs: true, claims: true }, false)
}

pub(super) fn verify(a: &Arguments) -> Result<Outcome, Failure> {
    work(a, Depth { labs: false, claims: true }, true)
}

/// Everything that was checked, and what it came to.
#[derive(Default)]
struct Course {
    checked: Vec<Checked>,
    findings: Vec<Finding>,
    ledger: Ledger,
    /// Files that are shown with findings, besides the lessons.
    sources: Vec<SourceFile>,
}

fn work(a: &Arguments, depth: Depth, evidence: bool) -> Result<Outcome, Failure> {
    let course = look(a, depth)?;
    let found = course.ledger.outcome();
    let named = || a.paths.iter().map(|p| printable_path(p)).collect::<Vec<_>>().join(", ");
    let claimed = |e: &Entry| {
        let claims = [Subject::Answer, Subject::Quote, Subject::ClosedForm, Subject::Run];
        claims.contains(&e.subject) && e.state != State::NotClaimed
    };
    let idle = evidence && !course.ledger.entries().iter().any(claimed);
    // Where nothing is claimed there is nothing to verify.
    let outcome = match found {
        ledger::Outcome::Clean if idle => ledger::Outcome::Nothing,
        found => found,
    };
    let mut sources: Vec<&SourceFile> = course.checked.iter().map(|c| &c.lesson.file).collect();
    sources.extend(&course.sources);
    match a.format {
        Format::Human => {
            let mut text = report::human(&course.findings, &sources, a.color.on());
            text.push_str(&overview(&course, evidence));
            if outcome == found {
                let _ = writeln!(text, "{}", last_line(&course));
            }
            print(&text)?;
        }
        Format::Json => {
            let name = if evidence { "verify" } else { "check" };
            let value =
                machine::value(name, outcome, &course.checked, &course.findings, &course.ledger, &sources);
            print_json(&value, true)?;
        }
    }
    match outcome {
        ledger::Outcome::Findings => Ok(Outcome::Findings),
        ledger::Outcome::Nothing if found == ledger::Outcome::Clean => Err(format!(
            "there is nothing to verify in {}: no question and no lab carries a `verify` object",
            named()
        )),
        ledger::Outcome::Nothing => {
            Err(format!("there is nothing to check in {}: no lab, no question and no model", named()))
        }
        ledger::Outcome::Clean => Ok(Outcome::Clean),
    }
}

/// Reads and checks every file. One that cannot be read is a finding and hides nothing of the others.
fn look(a: &Arguments, depth: Depth) -> Result<Course, Failure> {
    let (files, problems) = collect(&a.paths);
    if files.is_empty() {
        return Err(nothing(&a.paths, &problems));
    }
    let progress = a.format == Format::Human && std::io::stderr().is_terminal();
    let mut course = Course::default();
    let mut read = 0;
    // Models are shared by the lessons of a folder, and compiled once.
    let mut by_folder: BTreeMap<String, Models> = BTreeMap::new();
    let mut refused: Vec<(PathBuf, String)> = problems;
    for (i, (path, named)) in files.iter().enumerate() {
        if interrupted() {
            // What was asked for and not looked at is no silence.
            refused.extend(
                files.iter().skip(i).map(|(path, _)| (path.clone(), "interrupted before it was read".into())),
            );
            break;
        }
        if progress {
            complain(&format!("\r\x1b[Kchecking {}", printable_path(path)));
        }
        match kind_of(path) {
            FileKind::Lesson | FileKind::Json => {}
            FileKind::Model => {
                check_model(a, path, &mut course)?;
                read += 1;
                continue;
            }
            FileKind::Unknown => {
                let shown = printable_path(path);
                refused.push((path.clone(), format!("{shown} is no lesson: lessons are Markdown (.md, .markdown, .mdx, .qmd, .Rmd) or JSON, models are .xml")));
                continue;
            }
        }
        let folder = model_folder_within(&a.models, path, &a.paths)?;
        let models = by_folder.entry(format!("{folder:?}")).or_insert_with(|| Models::new(folder));
        let lesson = match load_lesson_file(path, models.folder()) {
            Ok(lesson) => lesson,
            Err(why) => {
                refused.push((path.clone(), why));
                continue;
            }
        };
        read += 1;
        if !named && is_other_json(&lesson) {
            continue;
        }
        let checked = check::check(lesson, models, depth);
        if interrupted() {
            // Runs were cut short: half of a check is none.
            let rest = files.iter().skip(i).map(|(path, _)| path.clone());
            refused.extend(rest.map(|path| (path, "interrupted before it was checked".into())));
            break;
        }
        course.checked.push(checked);
    }
    if progress {
        complain("\r\x1b[K");
    }
    if read == 0 {
        return Err(nothing(&a.paths, &refused));
    }
    for (path, why) in refused {
        let mut f = Finding::error(rules::UNREADABLE_FILE, 0..0, why)
            .why("nothing in it was checked")
            .help("mend the file, or leave it out");
        f.path = Arc::from(path.display().to_string());
        course.findings.push(f);
    }
    let lessons: Vec<_> = course.checked.iter().map(|c| &c.lesson).collect();
    course.findings.extend(lint::check_course(&lessons));
    course.findings.extend(course.checked.iter().flat_map(|c| c.findings.iter().cloned()));
    for models in by_folder.values_mut() {
        course.findings.extend(models.take_findings());
        course.sources.extend(models.files().iter().cloned());
    }
    finding::sort(&mut course.findings);
    let models = std::mem::take(&mut course.ledger);
    course.ledger = check::ledger(&course.checked, &course.findings);
    course.ledger.append(models);
    Ok(course)
}

/// Checks a model that was named itself.
fn check_model(a: &Arguments, path: &Path, course: &mut Course) -> Result<(), Failure> {
    let root = root(&a.models, &lint::lesson_folder(path), &[])?;
    let (model, findings, files) = check_model_file(path, Some(&root));
    let (state, word) = match model {
        Some(_) => (State::True(Evidence::Computed), "loads"),
        None => (State::False, "refused"),
    };
    let path: Arc<str> = Arc::from(path.display().to_string());
    course.ledger.add(Entry {
        subject: Subject::Model,
        owner: path.to_string(),
        path,
        span: 0..0,
        state,
        word,
        what: String::new(),
        remark: String::new(),
    });
    course.findings.extend(findings);
    course.sources.extend(files);
    Ok(())
}

/// Why nothing was checked, and what to do.
fn nothing(paths: &[PathBuf], problems: &[(PathBuf, String)]) -> Failure {
    let names: Vec<String> = paths.iter().map(|p| printable_path(p)).collect();
    match problems {
        [] => format!("no lessons in {}: name .md or .json files, or a folder of them", names.join(", ")),
        all => all.iter().map(|(_, why)| why.as_str()).collect::<Vec<_>>().join("\nlabspec: "),
    }
}

/// Other JSON lies in folders of lessons; a file that was named is always ours.
pub(super) fn is_other_json(lesson: &Lesson) -> bool {
    lesson.findings.iter().any(|f| f.code == "unknown-spec")
}

/// The files to check, in a fixed order, and whether each was named itself; and what could not be read.
#[allow(clippy::type_complexity)]
pub(super) fn collect(paths: &[PathBuf]) -> (Vec<(PathBuf, bool)>, Vec<(PathBuf, String)>) {
    let (mut files, mut problems) = (Vec::new(), Vec::new());
    for path in paths {
        match std::fs::metadata(path) {
            Err(e) => problems.push((path.clone(), format!("cannot read {}: {e}", printable_path(path)))),
            Ok(meta) if meta.is_dir() => walk(path, &mut files, &mut problems, 0),
            Ok(_) => files.push((path.clone(), true)),
        }
    }
    (files, problems)
}

/// Deepest nesting of folders.
const MAX_DEPTH: usize = 32;

fn walk(
    folder: &Path,
    files: &mut Vec<(PathBuf, bool)>,
    problems: &mut Vec<(PathBuf, String)>,
    depth: usize,
) {
    let mut problem = |why: String| problems.push((folder.to_path_buf(), why));
    if depth > MAX_DEPTH {
        return problem(format!("{} is nested more than {MAX_DEPTH} folders deep", printable_path(folder)));
    }
    let list = std::fs::read_dir(folder).and_then(|all| all.map(|e| e.map(|e| e.path())).collect());
    let mut entries: Vec<PathBuf> = match list {
        Ok(entries) => entries,
        Err(e) => return problem(format!("cannot read {}: {e}", printable_path(folder))),
    };
    entries.sort();
    for path in entries {
        let hidden = path
            .file_name()
            .and_then(|n| n.to_str())
            .is_some_and(|n| n.starts_with('.') || n == "node_modules");
        // Links are not followed: they may lead out of the folder, or round in a circle.
        let Ok(meta) = std::fs::symlink_metadata(&path) else { continue };
        if hidden || meta.is_symlink() {
            continue;
        }
        if meta.is_dir() {
            walk(&path, files, problems, depth + 1);
        } else if matches!(kind_of(&path), FileKind::Lesson | FileKind::Json) {
            files.push((path, false));
        }
    }
}

/// What was run and what was verified, lesson by lesson. Claims that are true stand together; each of the others stands
/// alone, with its reason.
fn overview(course: &Course, with_evidence: bool) -> String {
    let mut text = String::new();
    for c in &course.checked {
        let path = c.lesson.file.path();
        let all: Vec<&Entry> = course
            .ledger
            .entries()
            .iter()
            .filter(|e| e.path == *path && e.subject != Subject::File)
            .collect();
        if all.is_empty() {
            continue;
        }
        let _ = writeln!(text, "{}", printable(path));
        let mut told = 0;
        while let Some(entry) = all.get(told) {
            // Claims of the same kind, owner and state that follow each other are told together.
            let same =
                |e: &&&Entry| e.subject == entry.subject && e.owner == entry.owner && e.word == entry.word;
            let together = all.iter().skip(told).take_while(same).count().max(1);
            let good = matches!(entry.state, State::True(_));
            let n = if good && entry.subject != Subject::Lab { together } else { 1 };
            told += n;
            if let Some(line) = line(entry, n) {
                let _ = writeln!(text, "  {}", printable(&line));
            }
            let last = all.get(told).is_none_or(|next| next.owner != entry.owner);
            let claim = c.claims.iter().find(|claim| last && claim.name == entry.owner);
            let shown = claim.filter(|claim| with_evidence || claim.is_doubtful());
            for evidence in shown.into_iter().flat_map(check::evidence) {
                let _ = writeln!(text, "  {:<10}   {}", "", printable(&evidence));
            }
        }
        text.push('\n');
    }
    text
}

/// A line of the overview for so many claims of the same kind and state; `None` for what goes without saying.
fn line(entry: &Entry, n: usize) -> Option<String> {
    let remark = if entry.remark.is_empty() { String::new() } else { format!(": {}", entry.remark) };
    let good = matches!(entry.state, State::True(_));
    let Entry { owner, what, word, .. } = entry;
    let many = |one: &str| if n == 1 { format!("1 {one}") } else { format!("{n} {one}s") };
    Some(match entry.subject {
        Subject::File => return None,
        Subject::Run if good && *word == "made" => return None,
        Subject::Lab => {
            let title = if what.is_empty() { String::new() } else { format!(" \"{what}\"") };
            if good {
                format!("{:<10} {owner}{title}", entry.remark)
            } else {
                format!("{word:<10} {owner}{title}{remark}")
            }
        }
        Subject::Answer if good => format!("{word:<10} {owner}"),
        Subject::Answer => format!("{word:<10} {owner}{remark}"),
        Subject::Quote | Subject::ClosedForm if good => {
            format!("{word:<10} {owner}, {}", many(entry.subject.as_str()))
        }
        Subject::Quote | Subject::ClosedForm | Subject::Run => {
            format!("{word:<10} {owner}, {} \"{what}\"{remark}", entry.subject.as_str())
        }
        Subject::Model | Subject::Widget => format!("{word:<10} {owner}{remark}"),
    })
}

/// The last line: everything in numbers, and a judgement.
fn last_line(course: &Course) -> String {
    let found = Summary::of(&course.findings);
    let judgement = match (found.errors + found.warnings, course.ledger.outcome()) {
        (0, ledger::Outcome::Clean) if found.notes > 0 => format!("nothing to complain about, {found}"),
        (0, ledger::Outcome::Clean) => "nothing to complain about".into(),
        (0, ledger::Outcome::Nothing) => "nothing to check".into(),
        (0, ledger::Outcome::Findings) => "not everything could be checked".into(),
        _ => found.to_string(),
    };
    format!("{}: {judgement}", course.ledger.summary())
}
