//! The output of `check` and `verify` for programs: findings, the summary, all lessons, and the ledger.

use super::course::CourseResults;
use super::report_json::{MeasureRow, NonFinite, nonfinite, object, place};
use super::since::LessonChange;
use labspec::check::{Checked, Claim, RanLab, SnapshotResult};
use labspec::ledger::{Entry, Evidence, Outcome, State, Subject};
use labspec::report::{self, Summary, key};
use labspec::source::SourceFile;
use labspec::verify::{Answer, Quote, Weight};
use serde::Serialize;
use serde_json::{Map, Value};

/// The whole report.
#[derive(Serialize)]
pub(super) struct CheckReport<'a> {
    findings: Value,
    summary: SummaryRow,
    #[serde(rename = "aside")]
    suppressed: SuppressedRow<'a>,
    lessons: Vec<LessonRow<'a>>,
    ledger: Vec<EntryRow<'a>>,
    /// The changes since an earlier record, if one was named.
    pub(super) since: Option<&'a [LessonChange]>,
    /// The results of the reference simulator, if a recording was named.
    pub(super) judge: Option<Value>,
}

#[derive(Serialize)]
struct SummaryRow {
    errors: usize,
    warnings: usize,
    notes: usize,
    outcome: &'static str,
    claims: Map<String, Value>,
}

#[derive(Serialize)]
struct SuppressedRow<'a> {
    ignored: usize,
    #[serde(rename = "known")]
    baselined: usize,
    allowed: Vec<AllowedRow<'a>>,
}

#[derive(Serialize)]
struct AllowedRow<'a> {
    code: &'static str,
    why: &'a str,
    #[serde(flatten)]
    place: Value,
}

/// Builds the report of a check and its outcome. `sources` are the files to which locations refer.
pub(super) fn check_report<'a>(
    outcome: Outcome,
    results: &'a CourseResults,
    sources: &[&SourceFile],
) -> CheckReport<'a> {
    let CourseResults { checked, ledger, suppressed, .. } = results;
    let Summary { errors, warnings, notes } = Summary::count(&results.findings);
    let claims = object(Subject::ALL.iter().map(|s| (key(s.as_str()), ledger.count(*s))));
    let allowed = suppressed.allowed.iter().map(|a| AllowedRow {
        code: a.finding.code,
        why: &a.why,
        place: place(sources, &a.finding.path, &a.finding.span),
    });
    CheckReport {
        findings: report::json(&results.findings, sources)["findings"].take(),
        summary: SummaryRow { errors, warnings, notes, outcome: outcome.as_str(), claims },
        suppressed: SuppressedRow {
            ignored: suppressed.ignored.len(),
            baselined: suppressed.baselined.len(),
            allowed: allowed.collect(),
        },
        lessons: checked.iter().map(lesson).collect(),
        ledger: ledger.entries().iter().map(|e| entry(e, sources)).collect(),
        since: None,
        judge: None,
    }
}

#[derive(Serialize)]
struct EntryRow<'a> {
    subject: String,
    owner: &'a str,
    what: &'a str,
    #[serde(flatten)]
    place: Value,
    state: String,
    evidence: Option<&'static str>,
    word: &'static str,
    remark: &'a str,
}

fn entry<'a>(e: &'a Entry, sources: &[&SourceFile]) -> EntryRow<'a> {
    EntryRow {
        subject: key(e.subject.as_str()),
        owner: &e.owner,
        what: &e.what,
        place: place(sources, &e.path, &e.span),
        state: key(e.state.as_str()),
        evidence: match e.state {
            State::True(Evidence::Simulated) => Some("simulated"),
            State::True(Evidence::Computed) => Some("computed"),
            _ => None,
        },
        word: e.word,
        remark: &e.remark,
    }
}

#[derive(Serialize)]
pub(super) struct LessonRow<'a> {
    file: &'a str,
    labs: Vec<LabRow<'a>>,
    claims: Vec<ClaimRow<'a>>,
    snapshots: Vec<SnapshotRow<'a>>,
}

pub(super) fn lesson(c: &Checked) -> LessonRow<'_> {
    LessonRow {
        file: c.lesson.file.path(),
        labs: c.labs.iter().map(lab).collect(),
        claims: c.claims.iter().map(|claim_check| claim(claim_check, c)).collect(),
        snapshots: c.snapshots.iter().map(snapshot_row).collect(),
    }
}

/// The comparison of a lab with its snapshot.
#[derive(Serialize)]
pub(super) struct SnapshotRow<'a> {
    lab: &'a str,
    state: String,
    changes: &'a [String],
    rows: usize,
    divergence: Option<DivergenceRow<'a>>,
    reason: &'a str,
}

/// The first value that differs. Times are in s.
#[derive(Serialize)]
struct DivergenceRow<'a> {
    run: &'a str,
    trace: &'a str,
    time: f64,
    #[serde(skip_serializing_if = "NonFinite::is_empty")]
    nonfinite: NonFinite,
    stored: &'a str,
    #[serde(rename = "now")]
    current: &'a str,
    tolerance: Option<f64>,
    line: usize,
}

pub(super) fn snapshot_row(k: &SnapshotResult) -> SnapshotRow<'_> {
    SnapshotRow {
        lab: &k.lab,
        state: key(k.state.as_str()),
        changes: &k.changes,
        rows: k.rows,
        divergence: k.divergence.as_ref().map(|d| DivergenceRow {
            run: &d.run,
            trace: &d.trace,
            time: d.time,
            nonfinite: nonfinite(&[("time", &d.time)]),
            stored: &d.stored,
            current: &d.current,
            tolerance: d.tolerance,
            line: d.line,
        }),
        reason: &k.reason,
    }
}

/// A lab; the simulated time that its runs cover is in s.
#[derive(Serialize)]
struct LabRow<'a> {
    address: String,
    title: &'a str,
    runs: usize,
    ran: bool,
    broke: Option<bool>,
    seconds: Option<f64>,
    covered: Option<f64>,
    skipped: Option<usize>,
    ended: Option<&'a str>,
    #[serde(skip_serializing_if = "NonFinite::is_empty")]
    nonfinite: NonFinite,
}

fn lab(l: &RanLab) -> LabRow<'_> {
    let tried = l.tried.as_ref();
    LabRow {
        address: l.address.to_string(),
        title: &l.title,
        runs: l.runs,
        ran: l.ran,
        broke: tried.map(|t| t.broke),
        seconds: tried.map(|t| t.requested),
        covered: tried.map(|t| t.covered),
        skipped: tried.map(|t| t.skipped),
        ended: tried.and_then(|t| t.ended.as_deref()),
        nonfinite: tried
            .map_or(NonFinite::new(), |t| nonfinite(&[("seconds", &t.requested), ("covered", &t.covered)])),
    }
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct ClaimRow<'a> {
    name: &'a str,
    #[serde(flatten)]
    place: Value,
    answer: Option<AnswerRow<'a>>,
    quotes: Vec<QuoteRow<'a>>,
    closed_forms: Vec<ClosedFormRow<'a>>,
    runs: Vec<RunRow<'a>>,
    measures: Map<String, Value>,
}

#[derive(Serialize)]
struct ClosedFormRow<'a> {
    trace: &'a str,
    state: String,
    reason: &'a str,
}

#[derive(Serialize)]
struct RunRow<'a> {
    name: &'a str,
    broke: Option<&'a str>,
    expected: bool,
}

fn claim<'a>(claim: &'a Claim, c: &Checked) -> ClaimRow<'a> {
    let (j, file) = (&claim.judgement, &c.lesson.file);
    let form = j.exact.iter();
    let run = j.runs.iter();
    ClaimRow {
        name: &claim.name,
        place: place(&[file], file.path(), &claim.span),
        answer: j.answer.as_ref().map(answer),
        quotes: j.quotes.iter().map(quote).collect(),
        closed_forms: form
            .map(|e| ClosedFormRow { trace: &e.trace, state: key(e.state.as_str()), reason: &e.remark })
            .collect(),
        runs: run
            .map(|r| RunRow { name: &r.name, broke: r.broke.as_deref(), expected: r.is_break_expected() })
            .collect(),
        measures: object(j.measures.iter().map(|m| (m.name.clone(), MeasureRow::new(m)))),
    }
}

#[derive(Serialize)]
struct AnswerRow<'a> {
    verdict: &'static str,
    reason: &'a str,
    options: Vec<OptionRow>,
}

/// An option, in the unit of the comparison that decides it.
#[derive(Serialize)]
struct OptionRow {
    option: Option<usize>,
    holds: Option<bool>,
    margin: Option<f64>,
    spread: Option<f64>,
    #[serde(skip_serializing_if = "NonFinite::is_empty")]
    nonfinite: NonFinite,
}

fn answer(a: &Answer) -> AnswerRow<'_> {
    let option = |w: &Weight| OptionRow {
        option: w.option,
        holds: w.holds,
        margin: w.margin,
        spread: w.spread,
        nonfinite: nonfinite(&[("margin", &w.margin), ("spread", &w.spread)]),
    };
    AnswerRow {
        verdict: a.verdict.as_str(),
        reason: &a.reason,
        options: a.weights.iter().map(option).collect(),
    }
}

/// A quote; its value is in the unit of the text.
#[derive(Serialize)]
struct QuoteRow<'a> {
    text: &'a str,
    verdict: &'static str,
    reason: &'a str,
    computed: f64,
    #[serde(skip_serializing_if = "NonFinite::is_empty")]
    nonfinite: NonFinite,
}

fn quote(q: &Quote) -> QuoteRow<'_> {
    QuoteRow {
        text: &q.text,
        verdict: q.verdict(),
        reason: &q.reason,
        computed: q.computed,
        nonfinite: nonfinite(&[("computed", &q.computed)]),
    }
}
