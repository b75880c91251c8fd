//! `labspec check` and `labspec verify`.

use super::target::model_folder_within;
use super::{Color, Failure, ModelOptions, Outcome, print};
use crate::bind::scene::Models;
use crate::check::{self, Checked, Depth};
use crate::finding::{self, Finding, Severity};
use crate::lint;
use crate::report::{self, Summary};
use crate::source::SourceFile;
use crate::spec::{Lesson, load_lesson};
use crate::verify::{Verdict, significant};
use clap::ValueEnum;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::io::IsTerminal;
use std::path::{Path, PathBuf};

/// Arguments of `check` and `verify`.
#[derive(clap::Args, Debug)]
pub(super) struct Arguments {
    /// Lessons (.md), labs and quizzes (.json), or folders of them
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

fn work(a: &Arguments, depth: Depth, measures: bool) -> Result<Outcome, Failure> {
    let files = collect(&a.paths)?;
    let progress = a.format == Format::Human && std::io::stderr().is_terminal();
    // Models are shared by the lessons of a folder, and compiled once.
    let mut by_folder: BTreeMap<String, Models> = BTreeMap::new();
    let mut checked: Vec<Checked> = Vec::new();
    for (path, named) in &files {
        if progress {
            eprint!("\r\x1b[Kchecking {}", path.display());
        }
        let file = SourceFile::read(path)?;
        let folder = model_folder_within(&a.models, path, &a.paths)?;
        let models = by_folder.entry(format!("{folder:?}")).or_insert_with(|| Models::new(folder));
        let lesson = load_lesson(file, models.folder());
        if !named && is_other_json(&lesson) {
            continue;
        }
        checked.push(check::check(lesson, models, depth));
    }
    if progress {
        eprint!("\r\x1b[K");
    }

    let mut findings: Vec<Finding> = Vec::new();
    let lessons: Vec<_> = checked.iter().map(|c| &c.lesson).collect();
    findings.extend(lint::check_course(&lessons));
    for c in &checked {
        findings.extend(c.findings.iter().cloned());
    }
    for models in by_folder.values_mut() {
        findings.extend(models.take_findings());
    }
    finding::sort(&mut findings);
    let mut sources: Vec<&SourceFile> = checked.iter().map(|c| &c.lesson.file).collect();
    sources.extend(by_folder.values().flat_map(|m| m.files()));

    match a.format {
        Format::Human => {
            let mut text = report::human(&findings, &sources, a.color.on());
            text.push_str(&overview(&checked, measures));
            let _ = writeln!(text, "{}", last_line(&checked, &findings));
            print(&text)?;
        }
        Format::Json => {
            let mut value = report::json(&findings, &sources);
            value["lessons"] = checked.iter().map(lesson_json).collect();
            let text = serde_json::to_string_pretty(&value).map_err(|e| e.to_string())?;
            print(&format!("{text}\n"))?;
        }
    }
    let clean = findings.iter().all(|f| f.severity == Severity::Note);
    Ok(if clean { Outcome::Clean } else { Outcome::Findings })
}

/// Other JSON lies in folders of lessons; a file that was named is always ours.
pub(super) fn is_other_json(lesson: &Lesson) -> bool {
    lesson.findings.iter().any(|f| f.code == "unknown-spec")
}

/// The files to check, in a fixed order, and whether each was named itself.
pub(super) fn collect(paths: &[PathBuf]) -> Result<Vec<(PathBuf, bool)>, Failure> {
    let mut files = Vec::new();
    for path in paths {
        let meta = std::fs::metadata(path).map_err(|e| format!("cannot read {}: {e}", path.display()))?;
        if meta.is_dir() {
            walk(path, &mut files, 0)?;
        } else {
            files.push((path.clone(), true));
        }
    }
    if files.is_empty() {
        let names: Vec<String> = paths.iter().map(|p| p.display().to_string()).collect();
        return Err(format!(
            "no lessons in {}: name .md or .json files, or a folder of them",
            names.join(", ")
        ));
    }
    Ok(files)
}

/// Deepest nesting of folders.
const MAX_DEPTH: usize = 32;

fn walk(folder: &Path, files: &mut Vec<(PathBuf, bool)>, depth: usize) -> Result<(), Failure> {
    if depth > MAX_DEPTH {
        return Err(format!("{} is nested more than {MAX_DEPTH} folders deep", folder.display()));
    }
    let cannot = |e: std::io::Error| format!("cannot read {}: {e}", folder.display());
    let mut entries: Vec<PathBuf> = std::fs::read_dir(folder)
        .map_err(cannot)?
        .map(|e| e.map(|e| e.path()))
        .collect::<Result<_, _>>()
        .map_err(cannot)?;
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
            walk(&path, files, depth + 1)?;
        } else if path.extension().is_some_and(|e| e == "md" || e == "json") {
            files.push((path, false));
        }
    }
    Ok(())
}

/// What was run and what was verified, lesson by lesson.
fn overview(checked: &[Checked], measures: bool) -> String {
    let mut text = String::new();
    for c in checked {
        if c.labs.is_empty() && c.claims.is_empty() {
            continue;
        }
        let _ = writeln!(text, "{}", c.lesson.file.path());
        for lab in &c.labs {
            let title = if lab.title.is_empty() { String::new() } else { format!(" \"{}\"", lab.title) };
            let what = match lab.runs {
                0 => "could not run".to_string(),
                1 => "1 run".to_string(),
                n => format!("{n} runs"),
            };
            let _ = writeln!(text, "  {:<10} lab {}{title}", what, lab.address);
        }
        for claim in &c.claims {
            let quotes = match claim.quotes {
                0 => String::new(),
                1 => ", 1 quoted number".to_string(),
                n => format!(", {n} quoted numbers"),
            };
            let _ = writeln!(text, "  {:<10} {}{quotes}", claim.verdict.as_str(), claim.name);
            if measures {
                for (name, value) in &claim.measures {
                    let _ = writeln!(text, "  {:<10}   {name} = {}", "", significant(*value));
                }
            }
        }
        text.push('\n');
    }
    text
}

/// The last line: everything in numbers.
fn last_line(checked: &[Checked], findings: &[Finding]) -> String {
    let plural = |n: usize, one: &str| if n == 1 { format!("1 {one}") } else { format!("{n} {one}s") };
    let runs: usize = checked.iter().flat_map(|c| &c.labs).map(|l| l.runs).sum();
    let claims: Vec<Verdict> = checked.iter().flat_map(|c| &c.claims).map(|c| c.verdict).collect();
    let count = |v: Verdict| claims.iter().filter(|&&c| c == v).count();
    let mut parts = vec![plural(checked.len(), "file")];
    if runs > 0 {
        parts.push(plural(runs, "run"));
    }
    for verdict in [
        Verdict::Verified,
        Verdict::Fragile,
        Verdict::Ambiguous,
        Verdict::Refuted,
        Verdict::Failed,
        Verdict::Unverified,
    ] {
        if count(verdict) > 0 {
            parts.push(format!("{} {}", count(verdict), verdict.as_str()));
        }
    }
    format!("{}: {}", parts.join(", "), Summary::of(findings))
}

fn lesson_json(c: &Checked) -> Value {
    let labs: Vec<Value> = c
        .labs
        .iter()
        .map(|l| json!({"address": l.address.to_string(), "title": l.title, "runs": l.runs, "ran": l.ran}))
        .collect();
    let claims: Vec<Value> = c
        .claims
        .iter()
        .map(|claim| {
            let measures: serde_json::Map<String, Value> = claim.measures.iter().map(|(n, x)| (n.clone(), json!(x))).collect();
            let line = c.lesson.file.position(claim.span.start).line;
            json!({"name": claim.name, "line": line, "verdict": claim.verdict.as_str(), "measures": measures, "quotes": claim.quotes})
        })
        .collect();
    json!({"file": &**c.lesson.file.path(), "labs": labs, "claims": claims})
}
