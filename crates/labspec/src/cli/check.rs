//! `labspec check` and `labspec verify`.

use super::cache::Cache;
use super::course::{Course, Plan, look};
use super::stdio::print_json;
use super::{Color, Failure, ModelOptions, Outcome, machine, print, watch};
use crate::check::{self, Depth};
use crate::ledger::{self, Entry, State, Subject};
use crate::report::{self as drawn, Summary, printable, printable_path};
use crate::source::SourceFile;
use clap::ValueEnum;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::IsTerminal;
use std::num::NonZeroUsize;
use std::path::PathBuf;
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
    /// Check so many files at the same time [default: as many as there are processors]
    #[arg(long, value_name = "N")]
    jobs: Option<NonZeroUsize>,
    /// Check everything, also what has not changed since the last time, and keep nothing
    #[arg(long)]
    no_cache: bool,
    /// Check again whenever a file changes, until Ctrl-C
    #[arg(long)]
    watch: bool,
}

/// Arguments of `check`.
#[derive(clap::Args, Debug)]
pub(super) struct CheckArguments {
    #[command(flatten)]
    common: Arguments,
    /// Check structure, models and the names in every text, and run nothing: labs and claims are counted as left out,
    /// and the exit code is 3 where nothing is wrong
    #[arg(long)]
    no_run: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Format {
    /// For people
    Human,
    /// For programs
    Json,
}

pub(super) fn check(a: &CheckArguments) -> Result<Outcome, Failure> {
    work(&a.common, if a.no_run { Depth::STATIC } else { Depth::FULL }, false)
}

pub(super) fn verify(a: &Arguments) -> Result<Outcome, Failure> {
    work(a, Depth::CLAIMS, true)
}

/// Checks once, or again and again as files change.
fn work(a: &Arguments, depth: Depth, evidence: bool) -> Result<Outcome, Failure> {
    let cache = Cache::open(a.no_cache, a.watch);
    let known = || std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
    let plan = Plan {
        paths: &a.paths,
        models: &a.models,
        depth,
        jobs: a.jobs.map_or_else(known, NonZeroUsize::get),
        progress: a.format == Format::Human && std::io::stderr().is_terminal(),
        told: (a.format == Format::Human).then(|| a.color.on()),
    };
    if !a.watch {
        return report(a, &look(&plan, &cache)?, evidence);
    }
    watch::watch(&a.paths, || {
        let course = look(&plan, &cache)?;
        Ok((report(a, &course, evidence), course.read))
    })
}

/// Prints what a check came to.
fn report(a: &Arguments, course: &Course, evidence: bool) -> Result<Outcome, Failure> {
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
            let mut text = drawn::human(&course.last, &sources, a.color.on());
            text.push_str(&overview(course, evidence));
            if outcome == found {
                let _ = writeln!(text, "{}", last_line(course));
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
        ledger::Outcome::Partial => Ok(Outcome::Partial),
        ledger::Outcome::Clean => Ok(Outcome::Clean),
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
            let n = if plain && entry.subject != Subject::Lab { together } else { 1 };
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
    let left_out = entry.state == State::LeftOut;
    let titled = |what: &str| if what.is_empty() { String::new() } else { format!(" \"{what}\"") };
    let Entry { owner, what, word, .. } = entry;
    let many = |one: &str| if n == 1 { format!("1 {one}") } else { format!("{n} {one}s") };
    Some(match entry.subject {
        Subject::File => return None,
        Subject::Run if good && *word == "made" => return None,
        Subject::Answer | Subject::Lab if left_out => format!("{word:<10} {owner}{}", titled(what)),
        _ if left_out => format!("{word:<10} {owner}, {}", many(entry.subject.as_str())),
        Subject::Lab => {
            let title = titled(what);
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
        (0, ledger::Outcome::Partial) => "nothing wrong in what was checked, but nothing was run".into(),
        (0, ledger::Outcome::Findings) => "not everything could be checked".into(),
        _ => found.to_string(),
    };
    format!("{}: {judgement}", course.ledger.summary())
}
