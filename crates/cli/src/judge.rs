//! `--judge-request FILE` and `--judge FILE`: the real library as a second judge.
//!
//! We write what it is to run, `tests/judge/record.mjs` runs it, and what that has recorded is read here.

use super::common::Failure;
use super::course::CourseResults;
use super::output::write_file;
use super::output_kind::OutputKind;
use labspec::check::{CrossCheck, Recording, file_name};
use labspec::report::printable_lines;
use labspec::report::{printable_path, set_number};
use labspec::source::read_text;
use labspec::verify::judge::{Judged, Left, RecordedRun, shown_as};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

/// Bytes of a recording, at most.
const MOST: u64 = 64 << 20;
/// The version of both forms.
const VERSION: u64 = 1;

/// Writes what a judge is asked.
///
/// # Errors
/// The file cannot be written.
pub(super) fn write_request(file: &Path, results: &CourseResults) -> Result<(), Failure> {
    let mut runs = Vec::new();
    for (c, cross_check) in results.checked.iter().zip(&results.cross_checks) {
        let name = file_name(&c.lesson);
        runs.extend(cross_check.requests.iter().map(|r| match &r.task {
            Ok(task) => json!({"file": name, "claim": r.claim, "run": r.run, "hash": r.hash, "task": task}),
            Err(why) => json!({"file": name, "claim": r.claim, "run": r.run, "hash": r.hash, "refused": why}),
        }));
    }
    let request =
        json!({"request": "judge", "version": VERSION, "labspec": env!("CARGO_PKG_VERSION"), "runs": runs});
    let text = serde_json::to_string_pretty(&request).map_err(|e| e.to_string())?;
    write_file(file, OutputKind::JudgeRequest, &(text + "\n"))
}

/// Reads a recording.
///
/// # Errors
/// It cannot be read, or is none.
pub(super) fn read(file: &Path) -> Result<Recording, Failure> {
    let no = |why: &str| {
        format!(
            "{} is not a recording of a judge: {why}; tests/judge/record.mjs makes one from the file of `--judge-request FILE`",
            printable_path(file)
        )
    };
    let text = read_text(file, MOST, "a recording of a judge")?;
    let value: Value = serde_json::from_str(&text).map_err(|e| no(&e.to_string()))?;
    if value["recording"] != "judge" || value["version"] != VERSION {
        return Err(no("its version is missing or unsupported"));
    }
    let engine = value["engine"].as_str().filter(|e| !e.trim().is_empty() && e.len() < 100);
    let engine = engine.ok_or_else(|| no("it does not name its engine"))?.to_string();
    let runs = value["runs"].as_array().ok_or_else(|| no("it has no runs"))?;
    let mut recording = Recording { engine, ..Recording::default() };
    for (i, run) in runs.iter().enumerate() {
        let text = |key: &str| {
            run[key].as_str().map(str::to_string).ok_or_else(|| no(&format!("run {i} has no \"{key}\"")))
        };
        recording.recorded.insert([text("file")?, text("claim")?, text("run")?]);
        let taken = taken(run).map_err(|why| no(&format!("run {i}: {why}")))?;
        if let Some(before) = recording.runs.insert(text("hash")?, taken.clone())
            && format!("{before:?}") != format!("{taken:?}")
        {
            return Err(no(&format!("run {i} is recorded twice, with different numbers")));
        }
    }
    Ok(recording)
}

/// What JSON has no number for.
fn no_finite(name: &str) -> Option<f64> {
    match name {
        "NaN" => Some(f64::NAN),
        "Infinity" => Some(f64::INFINITY),
        "-Infinity" => Some(f64::NEG_INFINITY),
        _ => None,
    }
}

/// What is recorded of a run.
fn taken(run: &Value) -> Result<RecordedRun, String> {
    let mut taken = RecordedRun::default();
    let values = run["values"].as_object().ok_or("it has no \"values\"")?;
    for (name, value) in values {
        let x = value.as_f64().or_else(|| no_finite(value.as_str()?));
        taken
            .values
            .insert(name.clone(), x.ok_or_else(|| format!("the value of \"{name}\" is not a number"))?);
    }
    for (name, why) in run["refused"].as_object().into_iter().flatten() {
        let why = why.as_str().ok_or_else(|| format!("the reason for refusing \"{name}\" is not a text"))?;
        taken.refused.insert(name.clone(), why.to_string());
    }
    taken.warnings = match &run["warnings"] {
        Value::Null => 0,
        n => n.as_u64().and_then(|n| usize::try_from(n).ok()).ok_or("its \"warnings\" is not a count")?,
    };
    taken.broke = match &run["broke"] {
        Value::Null => None,
        why => Some(why.as_str().ok_or("its \"broke\" is not a text")?.to_string()),
    };
    Ok(taken)
}

/// What a judge makes of a results, all in all.
struct CrossCheckSummary<'c> {
    /// File, owner, and what became of it.
    claims: Vec<(String, &'c str, &'c Judged)>,
    /// What no judge is asked about.
    left: Left,
    stale: usize,
    missing: usize,
}

impl<'c> CrossCheckSummary<'c> {
    fn new(results: &'c CourseResults) -> CrossCheckSummary<'c> {
        let all = || results.checked.iter().zip(&results.cross_checks);
        let of = |(c, cross_check): (&labspec::check::Checked, &'c CrossCheck)| {
            let file = file_name(&c.lesson);
            cross_check.claims.iter().map(move |(owner, judged)| (file.clone(), owner.as_str(), judged))
        };
        CrossCheckSummary {
            claims: all().flat_map(of).collect(),
            left: results.cross_checks.iter().fold(Left::default(), |sum, h| sum.and(h.left)),
            stale: results.cross_checks.iter().map(|h| h.stale).sum(),
            missing: results.cross_checks.iter().map(|h| h.missing).sum(),
        }
    }

    fn count(&self, of: impl Fn(&Judged) -> usize) -> usize {
        self.claims.iter().map(|(.., judged)| of(judged)).sum()
    }
}

/// Whether something that is claimed was not judged for want of a recording.
pub(super) fn is_partial(results: &CourseResults) -> bool {
    let sum = CrossCheckSummary::new(results);
    sum.stale + sum.missing > 0
}

/// What the judge says, for people.
pub(super) fn summary(file: &Path, engine: &str, results: &CourseResults) -> String {
    let sum = CrossCheckSummary::new(results);
    let (compared, differing) = (sum.count(|j| j.compared), sum.count(|j| j.differing.len()));
    let (claims, turned) = (sum.count(|j| j.claims), sum.count(|j| j.turned));
    let mut text = String::new();
    let verb = if compared == 0 {
        "nothing was compared with"
    } else if differing + turned == 0 {
        "agrees with"
    } else {
        "differs from"
    };
    // Where something is left out, "all" is said of what was judged.
    let (left, judged) = match left(sum.left) {
        Some(left) => (format!("; not judged: {left}"), "judged "),
        None => (String::new(), ""),
    };
    let claimed = match (claims, turned) {
        (0, _) => "no verdict".to_string(),
        (1, 0) => format!("the one {judged}verdict"),
        (n, 0) => format!("all {n} {judged}verdicts"),
        (n, _) => format!("{} of {n} {judged}verdicts", n - turned),
    };
    let _ = write!(text, "{}: {verb} {engine}", printable_path(file));
    if compared > 0 {
        let _ = write!(text, ": {} of {compared} measures, {claimed}", compared - differing);
    }
    text.push_str(&left);
    text.push('\n');
    for (file, owner, judged) in &sum.claims {
        for (name, ours, theirs) in &judged.differing {
            let _ = writeln!(
                text,
                "  differs    {file}, {owner}: `{name}` is {} here but {} there",
                shown_as(*ours),
                shown_as(*theirs)
            );
        }
    }
    let mut reasons: BTreeMap<&str, usize> = BTreeMap::new();
    for (_, why) in sum.claims.iter().flat_map(|(.., judged)| &judged.unjudged) {
        *reasons.entry(why).or_default() += 1;
    }
    for (why, n) in &reasons {
        let what = if *n == 1 { "measure" } else { "measures" };
        let _ = writeln!(text, "  not judged {n} {what}: {why}");
    }
    if sum.stale + sum.missing > 0 {
        let _ =
            writeln!(text, "  record again: labspec check --judge-request FILE, then tests/judge/record.mjs");
    }
    printable_lines(&text).into_owned()
}

/// What the judge says, for programs.
pub(super) fn machine(engine: &str, results: &CourseResults) -> Value {
    let sum = CrossCheckSummary::new(results);
    let differing = sum.claims.iter().flat_map(|(file, owner, judged)| {
        judged.differing.iter().map(move |(name, ours, theirs)| {
            let mut one =
                json!({"file": file, "owner": owner, "measure": name, "ours": null, "theirs": null});
            set_number(&mut one, "ours", *ours);
            set_number(&mut one, "theirs", *theirs);
            one
        })
    });
    let unjudged = sum.claims.iter().flat_map(|(file, owner, judged)| {
        let one = move |(name, why): &(String, String)| json!({"file": file, "owner": owner, "measure": name, "reason": why});
        judged.unjudged.iter().map(one)
    });
    json!({
        "engine": engine, "compared": sum.count(|j| j.compared), "verdicts": sum.count(|j| j.claims),
        "turned": sum.count(|j| j.turned),
        "notJudged": {"searches": sum.left.searches, "ranges": sum.left.ranges, "closedForms": sum.left.forms},
        "staleRuns": sum.stale, "missingRuns": sum.missing,
        "differing": differing.collect::<Vec<_>>(), "unjudged": unjudged.collect::<Vec<_>>(),
    })
}

/// `2 searches, 1 range, 5 closed forms`; nothing where nothing is left.
fn left(left: Left) -> Option<String> {
    let kinds = [
        (left.searches, "search", "searches"),
        (left.ranges, "range", "ranges"),
        (left.forms, "closed form", "closed forms"),
    ];
    let nonzero = kinds.into_iter().filter(|(n, ..)| *n > 0);
    let nonzero: Vec<String> =
        nonzero.map(|(n, one, many)| format!("{n} {}", if n == 1 { one } else { many })).collect();
    (!nonzero.is_empty()).then(|| nonzero.join(", "))
}
