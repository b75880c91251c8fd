//! `labspec check` and `labspec verify`.

use super::baseline::Baseline;
use super::cache::Cache;
use super::collect::{STDIN, collect};
use super::fix::{Mode, fix};
use super::output::{Wanted, look_ahead, write_file};
use super::policy::PolicyOptions;
use super::scheduler::{Course, Judge, Plan, check_lessons};
use super::stdio::{complain, print_json};
use super::{Color, Failure, ModelOptions, Outcome, OutputKind, interrupted, machine, print, watch};
use super::{judge, reproduction, since};
use crate::check::{self, CheckLevel};
use crate::ledger::{self, Entry, State, Subject};
use crate::report::html::Material;
use crate::report::{self as drawn, Summary, printable, printable_path};
use crate::source::SourceFile;
use clap::ValueEnum;
use serde_json::Value;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::{IsTerminal, Read};
use std::num::NonZeroUsize;
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
    /// Output format
    #[arg(long, value_enum, default_value = "human")]
    format: Format,
    #[arg(long, value_enum, default_value = "auto", value_name = "WHEN")]
    color: Color,
    /// Number of files to check in parallel [default: the number of processors]
    #[arg(long, value_name = "N")]
    jobs: Option<NonZeroUsize>,
    /// Check everything, even unchanged files, and store no results
    #[arg(long)]
    no_cache: bool,
    /// Check again whenever a file changes, until Ctrl-C
    #[arg(long)]
    watch: bool,
    /// The name of the lesson that is read from standard input, where PATH is `-`
    #[arg(long, value_name = "NAME", default_value = "stdin.md")]
    stdin_name: PathBuf,
    #[command(flatten)]
    policy: PolicyOptions,
    /// Report only findings that are not in this file
    #[arg(long, value_name = "FILE")]
    baseline: Option<PathBuf>,
    /// Replace the baseline by the current findings
    #[arg(long, requires = "baseline")]
    update_baseline: bool,
    /// Write the runs for a second judge: every run of every `verify` object, for tests/judge/record.mjs
    #[arg(long, value_name = "FILE")]
    judge_request: Option<PathBuf>,
    /// Compare every measure with a recording of MuJoCo, and check every claim again with its numbers
    #[arg(long, value_name = "FILE")]
    judge: Option<PathBuf>,
    /// Show only the number of findings of each rule
    #[arg(long)]
    statistics: bool,
    /// Also show suppressed findings, with the reasons
    #[arg(long)]
    show_allowed: bool,
}

/// Arguments of `check`.
#[derive(clap::Args, Debug)]
pub(super) struct CheckArguments {
    #[command(flatten)]
    common: Arguments,
    /// Check structure, models and the names in every text, but run nothing: labs and claims count as left out,
    /// and the exit code is 3 if no problems are found
    #[arg(long)]
    no_run: bool,
    /// Apply safe fixes; every fix is checked before it is written
    #[arg(long)]
    fix: bool,
    /// Also apply fixes that are guesses
    #[arg(long)]
    unsafe_fixes: bool,
    /// Show what --fix would change, and change nothing
    #[arg(long)]
    diff: bool,
    /// Write every verdict with its basis: versions, settings of every run, digests of models and texts
    #[arg(long, value_name = "FILE", conflicts_with = "no_run")]
    record: Option<PathBuf>,
    /// Write a page for a browser: every verdict with its evidence, plots of the runs, and how much of the text is claimed
    #[arg(long, value_name = "FILE", conflicts_with = "no_run")]
    html: Option<PathBuf>,
    /// Report the changes since a recorded check: verdicts and values, with changed settings and models
    #[arg(long, value_name = "FILE", conflicts_with = "no_run")]
    since: Option<PathBuf>,
}

/// Files beside what is printed: a record to write, one to compare with, a page.
#[derive(Clone, Copy, Default)]
struct Records<'a> {
    write: Option<&'a Path>,
    html: Option<&'a Path>,
    since: Option<&'a Path>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Format {
    /// For people
    Human,
    /// A line for each finding
    Concise,
    /// For programs
    Json,
    /// A JSON object in each line
    Jsonl,
    /// Commands of GitHub's workflows
    Github,
    /// GitLab's report of code quality
    Gitlab,
    /// SARIF 2.1.0, for code scanning
    Sarif,
    /// JUnit: a test case for each claim
    Junit,
}

pub(super) fn check(a: &CheckArguments) -> Result<Outcome, Failure> {
    let depth = if a.no_run { CheckLevel::STATIC } else { CheckLevel::FULL };
    let fix = (a.fix || a.diff || a.unsafe_fixes).then_some(Mode { guesses: a.unsafe_fixes, diff: a.diff });
    let records = Records { write: a.record.as_deref(), html: a.html.as_deref(), since: a.since.as_deref() };
    work(&a.common, depth, false, fix, records)
}

pub(super) fn verify(a: &Arguments) -> Result<Outcome, Failure> {
    work(a, CheckLevel::CLAIMS, true, None, Records::default())
}

/// Checks once, or again and again as files change.
fn work(
    a: &Arguments,
    depth: CheckLevel,
    evidence: bool,
    mode: Option<Mode>,
    records: Records<'_>,
) -> Result<Outcome, Failure> {
    let cache = Cache::open(a.no_cache, a.watch);
    let known = || std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
    let piped = a.paths.iter().any(|p| p.as_os_str() == STDIN);
    let stdin = piped.then(|| read_stdin().map(|text| (a.stdin_name.clone(), text))).transpose()?;
    if piped && (a.watch || mode.is_some()) {
        return Err("--watch and --fix do not work on standard input; name a file".into());
    }
    let baseline = match &a.baseline {
        Some(file) if !a.update_baseline => Some(Baseline::read(file)?),
        _ => None,
    };
    let outputs = [
        (OutputKind::Record, records.write),
        (OutputKind::Page, records.html),
        (OutputKind::JudgeRequest, a.judge_request.as_deref()),
        (OutputKind::Baseline, a.baseline.as_deref().filter(|_| a.update_baseline)),
    ];
    let outputs: Vec<Wanted> = outputs
        .into_iter()
        .filter_map(|(kind, file)| Some(Wanted { kind, path: file?.to_path_buf() }))
        .collect();
    if !outputs.is_empty() {
        let read: Vec<PathBuf> = collect(&a.paths).files.into_iter().map(|(path, _)| path).collect();
        look_ahead(&read, &outputs)?;
    }
    // Read before anything is written: it may be the same file.
    let before = records.since.map(|file| Ok::<_, Failure>((file, reproduction::read(file)?))).transpose()?;
    let recording = a.judge.as_deref().map(judge::read).transpose()?;
    let plan = Plan {
        judge: Judge { ask: a.judge_request.is_some(), recording: recording.as_ref() },
        paths: &a.paths,
        basis: records.write.is_some() || before.is_some() || records.html.is_some(),
        curves: records.html.is_some(),
        stdin: stdin.as_ref(),
        policy: &a.policy,
        baseline: baseline.as_ref(),
        models: &a.models,
        depth,
        jobs: a.jobs.map_or_else(known, NonZeroUsize::get),
        progress: a.format == Format::Human && std::io::stderr().is_terminal(),
        reported: (a.format == Format::Human && !a.statistics).then(|| a.color.on()),
    };
    if let Some(mode) = mode {
        let repaired = fix(&plan, mode)?;
        if mode.diff {
            return Ok(if repaired.fixes > 0 { Outcome::Findings } else { Outcome::Clean });
        }
        if repaired.fixes > 0 {
            complain(&format!(
                "fixed {} in {}\n",
                many(repaired.fixes, "finding"),
                many(repaired.files, "file")
            ));
        }
    }
    if !a.watch {
        return report(a, &check_lessons(&plan, &cache)?, evidence, records, before.as_ref());
    }
    let settings: Vec<&Path> = a.policy.config().into_iter().chain(a.baseline.as_deref()).collect();
    watch::watch(&a.paths, &settings, || {
        let course = check_lessons(&plan, &cache)?;
        Ok((report(a, &course, evidence, records, before.as_ref()), course.read))
    })
}

/// Prints what a check came to.
fn report(
    a: &Arguments,
    course: &Course,
    evidence: bool,
    records: Records<'_>,
    before: Option<&(&Path, Value)>,
) -> Result<Outcome, Failure> {
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
    if let (Some(file), true) = (&a.baseline, a.update_baseline) {
        Baseline::new(file).write(file, &course.findings, &sources)?;
    }
    if let Some(file) = records.write.filter(|_| !interrupted()) {
        reproduction::write(file, &reproduction::now(file, course))?;
    }
    if let Some(file) = a.judge_request.as_deref().filter(|_| !interrupted()) {
        judge::ask(file, course)?;
    }
    if let Some(file) = records.html.filter(|_| !interrupted()) {
        let material = Material {
            lessons: &course.checked,
            curves: &course.curves,
            bases: &course.bases,
            findings: &course.findings,
            allowed: &course.suppressed.allowed,
            ledger: &course.ledger,
            sources: &sources,
            summary: &last_line(course),
        };
        write_file(file, OutputKind::Page, &drawn::html::page(&material))?;
    }
    let changes = before.map(|(file, old)| (file, since::changes(old, &reproduction::now(file, course))));
    match a.format {
        _ if a.statistics => print(&drawn::statistics(&course.findings))?,
        Format::Human => {
            let mut text = drawn::human(&course.last, &sources, a.color.on());
            if a.show_allowed {
                text.push_str(&allowed(course, &sources));
            }
            text.push_str(&overview(course, evidence));
            if let Some((file, changes)) = &changes {
                text.push_str(&since::summary(&file.display().to_string(), changes));
            }
            if let (Some(file), Some(engine)) = (&a.judge, &course.judged_by) {
                text.push_str(&judge::summary(file, engine, course));
            }
            if outcome == found {
                let _ = writeln!(text, "{}", last_line(course));
            }
            print(&text)?;
        }
        Format::Json => {
            let name = if evidence { "verify" } else { "check" };
            let mut value = machine::value(name, outcome, course, &sources);
            value["since"] = changes.as_ref().map_or(Value::Null, |(_, changes)| since::machine(changes));
            value["judge"] =
                course.judged_by.as_ref().map_or(Value::Null, |engine| judge::machine(engine, course));
            print_json(&value, true)?;
        }
        Format::Concise => print(&drawn::concise(&course.findings, &sources))?,
        Format::Jsonl => print(&drawn::jsonl(&course.findings, &sources))?,
        Format::Github => print(&drawn::github(&course.findings, &sources))?,
        Format::Gitlab => print_json(&drawn::gitlab(&course.findings, &sources), true)?,
        Format::Sarif => print_json(&drawn::sarif(&course.findings, &sources), true)?,
        Format::Junit => print(&drawn::junit(&course.ledger, &course.findings, &sources))?,
    }
    if a.update_baseline {
        // What is known now is known: the next check tells what is new.
        return Ok(Outcome::Clean);
    }
    match outcome {
        ledger::Outcome::Findings => Ok(Outcome::Findings),
        ledger::Outcome::Nothing if found == ledger::Outcome::Clean => {
            Err(format!("{} has nothing to verify: no question and no lab has a `verify` object", named()))
        }
        ledger::Outcome::Nothing => {
            Err(format!("{} has nothing to check: no lab, no question and no model", named()))
        }
        ledger::Outcome::Partial => Ok(Outcome::Partial),
        ledger::Outcome::Clean | ledger::Outcome::Known
            if course.judged_by.is_some() && judge::is_partial(course) =>
        {
            Ok(Outcome::Partial)
        }
        ledger::Outcome::Clean | ledger::Outcome::Known => Ok(Outcome::Clean),
    }
}

/// What was run and what was verified, lesson by lesson. Claims that are true stand together; each of the others stands
/// alone, with its reason.
fn overview(course: &Course, with_evidence: bool) -> String {
    let mut text = String::new();
    let mut by_path: BTreeMap<&Arc<str>, Vec<&Entry>> = BTreeMap::new();
    for entry in course.ledger.entries().iter().filter(|e| e.subject != Subject::File) {
        by_path.entry(&entry.path).or_default().push(entry);
    }
    for c in &course.checked {
        let path = c.lesson.file.path();
        let Some(all) = by_path.get(path) else { continue };
        let _ = writeln!(text, "{}", printable(path));
        let mut told = 0;
        while let Some(entry) = all.get(told) {
            // Claims of the same kind, owner and state that follow each other are told together.
            let same =
                |e: &&&Entry| e.subject == entry.subject && e.owner == entry.owner && e.word == entry.word;
            let together = all.iter().skip(told).take_while(same).count().max(1);
            let plain = matches!(entry.state, State::True(_) | State::LeftOut);
            let alone = matches!(entry.subject, Subject::Lab | Subject::Widget | Subject::Snapshot);
            let n = if plain && !alone { together } else { 1 };
            told += n;
            if let Some(line) = line(entry, n) {
                let _ = writeln!(text, "  {}", printable(&line));
            }
            let kept = c.snapshots.iter().find(|k| {
                entry.subject == Subject::Snapshot && entry.owner.strip_prefix("lab ") == Some(&*k.lab)
            });
            for shown in kept.into_iter().flat_map(check::SnapshotResult::shown) {
                let _ = writeln!(text, "  {:<10}   {}", "", printable(&shown));
            }
            let last = all.get(told).is_none_or(|next| next.owner != entry.owner);
            let last = last && entry.subject != Subject::Snapshot;
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
    let left_out = entry.state == State::LeftOut;
    let titled = |what: &str| if what.is_empty() { String::new() } else { format!(" \"{what}\"") };
    let Entry { owner, what, word, .. } = entry;
    Some(match entry.subject {
        Subject::File => return None,
        Subject::Run if good && *word == "made" => return None,
        Subject::Answer | Subject::Lab if left_out => format!("{word:<10} {owner}{}", titled(what)),
        Subject::Model | Subject::Widget => format!("{word:<10} {owner}{remark}"),
        Subject::Snapshot if left_out => format!("{word:<10} {owner}, its snapshot"),
        _ if left_out => format!("{word:<10} {owner}, {}", many(n, entry.subject.as_str())),
        Subject::Lab => {
            let title = titled(what);
            if good {
                format!("{:<10} {owner}{title}", entry.remark)
            } else {
                format!("{word:<10} {owner}{title}{remark}")
            }
        }
        Subject::Snapshot => format!("{word:<10} {owner}, its snapshot{remark}"),
        Subject::Answer if good => format!("{word:<10} {owner}"),
        Subject::Answer => format!("{word:<10} {owner}{remark}"),
        Subject::Option => format!("{word:<10} {owner}, option {what}"),
        Subject::Quote | Subject::ClosedForm if good => {
            format!("{word:<10} {owner}, {}", many(n, entry.subject.as_str()))
        }
        Subject::Quote | Subject::ClosedForm | Subject::Run => {
            format!("{word:<10} {owner}, {} \"{what}\"{remark}", entry.subject.as_str())
        }
    })
}

/// The last line: everything in numbers, and a judgement.
fn last_line(course: &Course) -> String {
    let found = Summary::of(&course.findings);
    let found = if course.findings.is_empty() { String::new() } else { found.to_string() };
    let judgement = course.ledger.conclusion(&found);
    format!("{}: {judgement}{}", course.ledger.summary(), suppressed_summary(course))
}

/// What was found and not told, in numbers.
fn suppressed_summary(course: &Course) -> String {
    let aside = &course.suppressed;
    let ignored = Summary::of(&aside.ignored);
    let parts = [
        (aside.ignored.len(), format!("{ignored} ignored")),
        (aside.allowed.len(), format!("{} suppressed by the lessons", many(aside.allowed.len(), "finding"))),
        (aside.baselined.len(), format!("{} in the baseline", many(aside.baselined.len(), "finding"))),
    ];
    let parts: Vec<String> = parts.into_iter().filter(|(n, _)| *n > 0).map(|(_, text)| text).collect();
    if parts.is_empty() { String::new() } else { format!(" ({})", parts.join(", ")) }
}

/// What the lessons allow, a line for each finding, with the reason.
fn allowed(course: &Course, sources: &[&SourceFile]) -> String {
    let mut text = String::new();
    for aside in &course.suppressed.allowed {
        let line = drawn::concise(std::slice::from_ref(&aside.finding), sources);
        let _ = writeln!(text, "{}\n  suppressed: {}", line.trim_end(), printable(&aside.why));
    }
    if !text.is_empty() {
        text.push('\n');
    }
    text
}

fn many(n: usize, one: &str) -> String {
    if n == 1 { format!("1 {one}") } else { format!("{n} {one}s") }
}

/// Most bytes of a lesson on standard input.
const MOST: u64 = 64 << 20;

fn read_stdin() -> Result<String, Failure> {
    let mut text = String::new();
    let read = std::io::stdin().lock().take(MOST + 1).read_to_string(&mut text);
    let no = |why: String| format!("cannot read standard input: {why}");
    read.map_err(|e| no(e.to_string()))?;
    if text.len() as u64 > MOST { Err(no(format!("it has more than {MOST} bytes"))) } else { Ok(text) }
}
