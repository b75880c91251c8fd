//! `--judge-request FILE` and `--judge FILE`: comparison with the real MuJoCo library.
//!
//! labspec writes a request, `tests/judge/record.mjs` runs it, and this module reads the recording.

use super::common::Failure;
use super::course::CourseResults;
use super::output::write_file;
use super::output_kind::OutputKind;
use super::schema_words::AnyNumber;
use labspec::check::{ReferenceRecording, file_name};
use labspec::report::printable_lines;
use labspec::report::{nonfinite, printable_path};
use labspec::source::read_text;
use labspec::verify::judge::{Difference, RecordedRun, RunTask, Unjudged};
use schemars::JsonSchema;
use serde::de::IgnoredAny;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

/// The maximum size of a recording in bytes.
const MAX_RECORDING: u64 = 64 << 20;
/// The version of both formats.
const VERSION: u64 = 1;

/// The request to the reference simulator.
#[derive(Serialize)]
struct JudgeRequest<'c> {
    request: &'c str,
    version: u64,
    labspec: &'c str,
    runs: Vec<RequestedRun<'c>>,
}

/// A requested run, or the reason why it is not requested.
#[derive(Serialize)]
struct RequestedRun<'c> {
    file: String,
    claim: &'c str,
    run: &'c str,
    hash: &'c str,
    #[serde(skip_serializing_if = "Option::is_none")]
    task: Option<&'c RunTask>,
    #[serde(skip_serializing_if = "Option::is_none")]
    refused: Option<&'c str>,
}

/// The recording as the reference simulator writes it.
#[derive(Default, Deserialize)]
#[serde(default)]
struct RecordingFile {
    recording: ParsedField<String>,
    version: ParsedField<u64>,
    engine: ParsedField<String>,
    runs: ParsedField<Vec<ParsedField<RecordingRow>>>,
}

/// A run in the recording.
#[derive(Default, Deserialize)]
#[serde(default)]
struct RecordingRow {
    file: ParsedField<String>,
    claim: ParsedField<String>,
    run: ParsedField<String>,
    hash: ParsedField<String>,
    values: ParsedField<BTreeMap<String, ParsedField<RecordedNumber>>>,
    refused: ParsedField<BTreeMap<String, ParsedField<String>>>,
    #[serde(rename = "nan")]
    without_value: ParsedField<BTreeMap<String, ParsedField<String>>>,
    warnings: Option<ParsedField<usize>>,
    broke: Option<ParsedField<String>>,
}

/// A number, or the name of a value that JSON cannot represent.
#[derive(Deserialize)]
#[serde(untagged)]
enum RecordedNumber {
    Finite(f64),
    Named(String),
}

/// A field of a file from another program. A wrong type is an error of this field, not of the whole file.
#[derive(Deserialize)]
#[serde(untagged)]
enum ParsedField<T> {
    Valid(T),
    Invalid(IgnoredAny),
}

impl<T> Default for ParsedField<T> {
    fn default() -> ParsedField<T> {
        ParsedField::Invalid(IgnoredAny)
    }
}

impl<T> ParsedField<T> {
    fn valid(&self) -> Option<&T> {
        match self {
            ParsedField::Valid(value) => Some(value),
            ParsedField::Invalid(_) => None,
        }
    }
}

/// What a second judge makes of the claims.
#[derive(Default, Serialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub(super) struct JudgeReport<'c> {
    /// What made the recording: `MuJoCo 3.14.0`.
    engine: &'c str,
    /// Measures that were compared.
    compared: usize,
    /// Answers and quoted numbers that were judged again.
    verdicts: usize,
    /// The number of verdicts that differ from those of labspec; each is a finding.
    turned: usize,
    /// Claims that are not cross-checked, because they depend on runs that are not recorded.
    not_judged: Unjudged,
    /// The number of runs whose lesson or model has changed since the recording.
    stale_runs: usize,
    /// Runs that are not recorded.
    missing_runs: usize,
    /// Measures with another value.
    differing: Vec<DifferenceRow<'c>>,
    /// Measures that the recording does not contain.
    unjudged: Vec<UnjudgedRow<'c>>,
}

/// A measure with another value.
#[derive(Serialize, JsonSchema)]
struct DifferenceRow<'c> {
    /// The name of the lesson's file, without its folder.
    file: String,
    /// The lab or the question.
    owner: &'c str,
    /// Run and measure, or the expression itself.
    measure: &'c str,
    /// The value here.
    #[serde(rename = "ours")]
    #[schemars(with = "AnyNumber")]
    labspec_value: f64,
    /// The value that is recorded.
    #[serde(rename = "theirs")]
    #[schemars(with = "AnyNumber")]
    reference_value: f64,
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    nonfinite: BTreeMap<&'c str, &'c str>,
    /// Why one of the values is NaN, if that is known.
    #[serde(rename = "reason", skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    no_value: Option<&'c str>,
    #[serde(skip)]
    difference: &'c Difference,
}

/// A measure that the judge has not taken.
#[derive(Serialize, JsonSchema)]
struct UnjudgedRow<'c> {
    /// The name of the lesson's file, without its folder.
    file: String,
    /// The lab or the question.
    owner: &'c str,
    /// Run and measure, or the expression itself.
    measure: &'c str,
    /// Why, in a clause.
    reason: &'c str,
}

/// Writes the request to the reference simulator.
///
/// # Errors
/// The file cannot be written.
pub(super) fn write_request(file: &Path, results: &CourseResults) -> Result<(), Failure> {
    let mut runs = Vec::new();
    for (c, cross_check) in results.checked.iter().zip(&results.cross_checks) {
        runs.extend(cross_check.requests.iter().map(|r| RequestedRun {
            file: file_name(&c.lesson),
            claim: &r.claim,
            run: &r.run,
            hash: &r.hash,
            task: r.task.as_ref().ok(),
            refused: r.task.as_ref().err().map(String::as_str),
        }));
    }
    let request =
        JudgeRequest { request: "judge", version: VERSION, labspec: env!("CARGO_PKG_VERSION"), runs };
    let text = serde_json::to_string_pretty(&request).map_err(|e| e.to_string())?;
    write_file(file, OutputKind::JudgeRequest, &(text + "\n"))
}

/// Reads a recording.
///
/// # Errors
/// The file cannot be read, or is not a recording.
pub(super) fn read(file: &Path) -> Result<ReferenceRecording, Failure> {
    let no = |why: &str| {
        format!(
            "{} is not a recording of a cross-check: {why}; tests/judge/record.mjs makes one from the file of `--judge-request FILE`",
            printable_path(file)
        )
    };
    let text = read_text(file, MAX_RECORDING, "a recording of a judge")?;
    let read: ParsedField<RecordingFile> = serde_json::from_str(&text).map_err(|e| no(&e.to_string()))?;
    let expected = |f: &&RecordingFile| {
        f.recording.valid().is_some_and(|name| name == "judge") && f.version.valid() == Some(&VERSION)
    };
    let read = read.valid().filter(expected).ok_or_else(|| no("its version is missing or unsupported"))?;
    let engine = read.engine.valid().filter(|e| !e.trim().is_empty() && e.len() < 100);
    let engine = engine.ok_or_else(|| no("it does not name its engine"))?.clone();
    let mut recording = ReferenceRecording { engine, ..ReferenceRecording::default() };
    for (i, row) in read.runs.valid().ok_or_else(|| no("it has no runs"))?.iter().enumerate() {
        let empty = RecordingRow::default();
        let row = row.valid().unwrap_or(&empty);
        let text = |field: &ParsedField<String>, key: &str| {
            field.valid().cloned().ok_or_else(|| no(&format!("run {i} has no \"{key}\"")))
        };
        recording.recorded.insert([
            text(&row.file, "file")?,
            text(&row.claim, "claim")?,
            text(&row.run, "run")?,
        ]);
        let recorded = recorded(row).map_err(|why| no(&format!("run {i}: {why}")))?;
        if let Some(before) = recording.runs.insert(text(&row.hash, "hash")?, recorded.clone())
            && format!("{before:?}") != format!("{recorded:?}")
        {
            return Err(no(&format!("run {i} is recorded twice, with different numbers")));
        }
    }
    Ok(recording)
}

fn number(recorded: &RecordedNumber) -> Option<f64> {
    match recorded {
        RecordedNumber::Finite(x) => Some(*x),
        RecordedNumber::Named(name) => match name.as_str() {
            "NaN" => Some(f64::NAN),
            "Infinity" => Some(f64::INFINITY),
            "-Infinity" => Some(f64::NEG_INFINITY),
            _ => None,
        },
    }
}

/// The recorded values of a run.
fn recorded(row: &RecordingRow) -> Result<RecordedRun, String> {
    let mut recorded = RecordedRun::default();
    for (name, value) in row.values.valid().ok_or("it has no \"values\"")? {
        let x = value.valid().and_then(number);
        let x = x.ok_or_else(|| format!("the value of \"{name}\" is not a number"))?;
        recorded.values.insert(name.clone(), x);
    }
    for (name, why) in row.refused.valid().into_iter().flatten() {
        let why = why.valid().ok_or_else(|| format!("the reason for refusing \"{name}\" is not a text"))?;
        recorded.refused.insert(name.clone(), why.clone());
    }
    for (name, why) in row.without_value.valid().into_iter().flatten() {
        let why = why.valid().ok_or_else(|| format!("the reason why \"{name}\" is NaN is not a text"))?;
        recorded.without_value.insert(name.clone(), why.clone());
    }
    if let Some(n) = &row.warnings {
        recorded.warnings = *n.valid().ok_or("its \"warnings\" is not a count")?;
    }
    if let Some(why) = &row.broke {
        recorded.broke = Some(why.valid().ok_or("its \"broke\" is not a text")?.clone());
    }
    Ok(recorded)
}

impl<'c> JudgeReport<'c> {
    fn new(engine: &'c str, results: &'c CourseResults) -> JudgeReport<'c> {
        let mut all = JudgeReport { engine, ..JudgeReport::default() };
        for (c, cross_check) in results.checked.iter().zip(&results.cross_checks) {
            all.not_judged = all.not_judged.and(cross_check.left);
            all.stale_runs += cross_check.stale;
            all.missing_runs += cross_check.missing;
            for (owner, judged) in &cross_check.claims {
                let file = || file_name(&c.lesson);
                all.compared += judged.compared;
                all.verdicts += judged.claims;
                all.turned += judged.turned;
                all.differing.extend(judged.differing.iter().map(|difference| {
                    let Difference { name: measure, labspec_value, reference_value, no_value } = difference;
                    let both = [("ours", *labspec_value), ("theirs", *reference_value)].into_iter();
                    let nonfinite = both.filter_map(|(key, x)| Some((key, nonfinite(x)?))).collect();
                    let no_value = no_value.as_deref();
                    DifferenceRow {
                        file: file(),
                        owner,
                        measure,
                        labspec_value: *labspec_value,
                        reference_value: *reference_value,
                        nonfinite,
                        no_value,
                        difference,
                    }
                }));
                let unjudged = judged.unjudged.iter();
                all.unjudged.extend(unjudged.map(|(measure, reason)| UnjudgedRow {
                    file: file(),
                    owner,
                    measure,
                    reason,
                }));
            }
        }
        all
    }
}

/// Whether a claim could not be compared because a recording is missing or out of date.
pub(super) fn is_partial(results: &CourseResults) -> bool {
    results.cross_checks.iter().any(|h| h.stale + h.missing > 0)
}

/// The results of the comparison, for people.
pub(super) fn summary(file: &Path, engine: &str, results: &CourseResults) -> String {
    let all = JudgeReport::new(engine, results);
    let (compared, differing, turned) = (all.compared, all.differing.len(), all.turned);
    let mut text = String::new();
    let verb = if compared == 0 {
        "nothing was compared with"
    } else if differing + turned == 0 {
        "agrees with"
    } else {
        "differs from"
    };
    // If something was left out, "all" refers only to what was compared.
    let (left, judged) = match describe_unjudged(all.not_judged) {
        Some(left) => (format!("; not judged: {left}"), "judged "),
        None => (String::new(), ""),
    };
    let claimed = match (all.verdicts, turned) {
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
    for DifferenceRow { file, owner, difference, .. } in &all.differing {
        let _ = writeln!(text, "  differs    {file}, {owner}: {}", difference.describe());
    }
    let mut reasons: BTreeMap<&str, usize> = BTreeMap::new();
    for unjudged in &all.unjudged {
        *reasons.entry(unjudged.reason).or_default() += 1;
    }
    for (why, n) in &reasons {
        let what = if *n == 1 { "measure" } else { "measures" };
        let _ = writeln!(text, "  not judged {n} {what}: {why}");
    }
    if all.stale_runs + all.missing_runs > 0 {
        let _ =
            writeln!(text, "  record again: labspec check --judge-request FILE, then tests/judge/record.mjs");
    }
    printable_lines(&text).into_owned()
}

/// The results of the comparison, for programs.
pub(super) fn machine<'c>(engine: &'c str, results: &'c CourseResults) -> JudgeReport<'c> {
    JudgeReport::new(engine, results)
}

/// `2 searches, 1 range, 5 closed forms`, or `None` if nothing was left out.
fn describe_unjudged(left: Unjudged) -> Option<String> {
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
