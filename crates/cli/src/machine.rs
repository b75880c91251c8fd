//! The output of `check` and `verify` for programs: findings, the summary, all lessons, and the ledger.

use super::course::CourseResults;
use super::judge::JudgeReport;
use super::report_json::{MeasureRow, NonFinite, nonfinite, object};
use super::schema_words::{AnyNumber, WordOf, Words};
use super::since::LessonChange;
use labspec::check::{Checked, Claim, RanLab, SnapshotResult};
use labspec::ledger::{Count, Entry, Evidence, Ledger, Outcome, State, Subject};
use labspec::report::{FindingRow, PartOf, PlaceFields, Summary, key};
use labspec::source::SourceFile;
use labspec::verify::{Answer, Quote, Verdict, Weight};
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::{Map, Value};
use std::collections::{BTreeMap, BTreeSet};

/// The report of `check` and `verify`: every finding, the state of every claim, and the summary that determines the exit code.
#[derive(Serialize, JsonSchema)]
pub(super) struct CheckReport<'a> {
    /// All findings, ordered by path and by position in the file.
    findings: Vec<FindingRow<'a>>,
    /// The findings and the ledger in numbers.
    summary: SummaryRow,
    /// Findings that are not in `findings`: ignored, in the baseline, or suppressed by the lesson.
    #[serde(rename = "aside")]
    suppressed: SuppressedRow<'a>,
    /// Every file that was checked, with what ran and what was judged.
    lessons: Vec<LessonRow<'a>>,
    /// Every claim, in the order of the files.
    ledger: Vec<EntryRow<'a>>,
    /// What has changed since the check that `--since` names; null without it.
    pub(super) since: Option<&'a [LessonChange]>,
    /// The result of the cross-check with a recording of MuJoCo (`--judge`); null without one.
    pub(super) judge: Option<JudgeReport<'a>>,
}

/// The findings and the ledger in numbers.
#[derive(Serialize, JsonSchema)]
struct SummaryRow {
    /// Findings that are errors.
    errors: usize,
    /// Findings that are warnings.
    warnings: usize,
    /// Findings that are notes.
    notes: usize,
    /// The outcome: `clean` (exit code 0), `findings` (1), `partial` (3), `known` (0, all in the baseline), `nothing` (2).
    #[schemars(extend("enum" = Outcome::ALL.map(Outcome::as_str)))]
    outcome: &'static str,
    /// Claims by subject.
    claims: ClaimCounts,
}

/// Claims by subject.
#[derive(Serialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
struct ClaimCounts {
    /// Files in which nothing is wrong.
    file: Count,
    /// Models that were named themselves.
    model: Count,
    /// Labs that run.
    lab: Count,
    /// Blocks of other widgets, which are not run.
    other_widget: Count,
    /// Runs of `verify` objects.
    run: Count,
    /// Keyed answers.
    answer: Count,
    /// Options that the evidence does not decide.
    option: Count,
    /// Numbers quoted in the text.
    quoted_number: Count,
    /// Traces that follow their closed form.
    closed_form: Count,
    /// Labs whose traces and readouts are as stored in the snapshot of their lesson.
    snapshot: Count,
    /// Listings that print the output below them (`--listings`).
    listing: Count,
    /// Numbers in the text that the output of such a listing has (`--listings`).
    printed_number: Count,
}

impl ClaimCounts {
    fn new(ledger: &Ledger) -> ClaimCounts {
        ClaimCounts {
            file: ledger.count(Subject::File),
            model: ledger.count(Subject::Model),
            lab: ledger.count(Subject::Lab),
            other_widget: ledger.count(Subject::Widget),
            run: ledger.count(Subject::Run),
            answer: ledger.count(Subject::Answer),
            option: ledger.count(Subject::Option),
            quoted_number: ledger.count(Subject::Quote),
            closed_form: ledger.count(Subject::ClosedForm),
            snapshot: ledger.count(Subject::Snapshot),
            listing: ledger.count(Subject::Listing),
            printed_number: ledger.count(Subject::PrintedNumber),
        }
    }
}

/// What was found and is not among the findings.
#[derive(Serialize, JsonSchema)]
struct SuppressedRow<'a> {
    /// The number of findings of rules that are not selected or are ignored.
    ignored: usize,
    /// Findings that are in the baseline.
    #[serde(rename = "known")]
    baselined: usize,
    /// Findings that the lessons allow.
    allowed: Vec<AllowedRow<'a>>,
}

/// A finding that a lesson allows.
#[derive(Serialize, JsonSchema)]
struct AllowedRow<'a> {
    /// The rule's code.
    code: &'static str,
    /// The author's reason.
    why: &'a str,
    #[serde(flatten)]
    #[schemars(with = "PartOf<PlaceFields<'static>>")]
    place: PlaceFields<'a>,
}

/// Builds the report of a check and its outcome. `sources` are the files to which locations refer.
pub(super) fn check_report<'a>(
    outcome: Outcome,
    results: &'a CourseResults,
    sources: &[&SourceFile],
) -> CheckReport<'a> {
    let CourseResults { checked, ledger, suppressed, .. } = results;
    let Summary { errors, warnings, notes } = Summary::count(&results.findings);
    let allowed = suppressed.allowed.iter().map(|a| AllowedRow {
        code: a.finding.code,
        why: &a.why,
        place: PlaceFields::new(sources, &a.finding.path, &a.finding.span),
    });
    CheckReport {
        findings: results.findings.iter().map(|f| FindingRow::new(f, sources)).collect(),
        summary: SummaryRow {
            errors,
            warnings,
            notes,
            outcome: outcome.as_str(),
            claims: ClaimCounts::new(ledger),
        },
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

/// One claim of the ledger.
#[derive(Serialize, JsonSchema)]
struct EntryRow<'a> {
    /// What it is about.
    #[schemars(extend("enum" = Subject::ALL.map(|subject| key(subject.as_str()))))]
    subject: String,
    /// Who claims it.
    owner: &'a str,
    /// What is claimed, where the owner claims several; else empty.
    what: &'a str,
    #[serde(flatten)]
    #[schemars(with = "PartOf<PlaceFields<'static>>")]
    place: PlaceFields<'a>,
    /// What became of it.
    #[schemars(with = "WordOf<State>")]
    state: String,
    /// The evidence for a true claim: `simulated` or `computed`; null for other states.
    #[schemars(extend("enum" = evidence_words()))]
    evidence: Option<&'static str>,
    /// The state in a word, for people.
    word: &'static str,
    /// Why it is not true, or what was covered; else empty.
    remark: &'a str,
}

fn entry<'a>(e: &'a Entry, sources: &[&SourceFile]) -> EntryRow<'a> {
    EntryRow {
        subject: key(e.subject.as_str()),
        owner: &e.owner,
        what: &e.what,
        place: PlaceFields::new(sources, &e.path, &e.span),
        state: key(e.state.as_str()),
        evidence: evidence_word(e.state),
        word: e.word,
        remark: &e.remark,
    }
}

/// All words for it.
fn evidence_words() -> BTreeSet<Option<&'static str>> {
    State::ALL.map(evidence_word).into()
}

/// How a claim was found true.
fn evidence_word(state: State) -> Option<&'static str> {
    match state {
        State::True(Evidence::Simulated) => Some("simulated"),
        State::True(Evidence::Computed) => Some("computed"),
        _ => None,
    }
}

/// A file.
#[derive(Serialize, JsonSchema)]
pub(super) struct LessonRow<'a> {
    /// Its path.
    file: &'a str,
    /// Its labs.
    labs: Vec<LabRow<'a>>,
    /// What it claims.
    claims: Vec<ClaimRow<'a>>,
    /// For each lab, whether it matches its stored snapshot; empty if the lesson has no snapshot.
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

/// What became of the snapshot of a lab.
#[derive(Serialize, JsonSchema)]
pub(super) struct SnapshotRow<'a> {
    /// The lab's address: `#1`.
    lab: &'a str,
    /// Whether it is as stored.
    #[schemars(with = "WordOf<State>")]
    state: String,
    /// What changed about the lab, a clause each: a control, a trace, a setting.
    changes: &'a [String],
    /// The number of traces and readouts that differ from the snapshot, over all runs.
    rows: usize,
    /// The earliest value that differs from the snapshot in the first run that differs; null if none does.
    divergence: Option<DivergenceRow<'a>>,
    /// Why it could not be checked; empty otherwise.
    reason: &'a str,
}

/// The first value that is not as stored.
#[derive(Serialize, JsonSchema)]
struct DivergenceRow<'a> {
    /// The run: `as it stands`, `with "k" at 2`.
    run: &'a str,
    /// The trace or readout, as a column of the report `run`.
    trace: &'a str,
    /// Simulated time, in seconds.
    time: f64,
    // Values are compared at times that are stored, which are finite.
    #[serde(skip_serializing_if = "NonFinite::is_empty")]
    #[schemars(skip)]
    nonfinite: NonFinite,
    /// What is stored, as it stands there.
    stored: &'a str,
    /// The current value, with a digit more.
    #[serde(rename = "now")]
    current: &'a str,
    /// The tolerance of a number: half a unit of its last stored digit; null if the stored value is not a number.
    tolerance: Option<f64>,
    /// The line of the snapshot, from 1.
    #[schemars(range(min = 1))]
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

/// A lab that was run.
#[derive(Serialize, JsonSchema)]
struct LabRow<'a> {
    /// Its address, as for `labspec run`: `#1`, `#quiz-id.1`.
    address: String,
    /// Its title; empty without one.
    title: &'a str,
    /// Runs that were made: as it stands, and with its controls moved.
    runs: usize,
    /// It could be run.
    ran: bool,
    /// A run broke; null when it could not be run.
    broke: Option<bool>,
    /// How long each run was meant to be, in seconds of simulation; null when it could not be run.
    #[schemars(with = "AnyNumber")]
    seconds: Option<f64>,
    /// How long the shortest run was.
    #[schemars(with = "AnyNumber")]
    covered: Option<f64>,
    /// Runs that were not made; null when it could not be run.
    skipped: Option<usize>,
    /// Why a run ended before its time; null when none did.
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

/// A question, or a lab with a `verify` object.
#[derive(Serialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
struct ClaimRow<'a> {
    /// What claims it: `quiz fall, question 2`, `lab #2`.
    name: &'a str,
    #[serde(flatten)]
    #[schemars(with = "PartOf<PlaceFields<'static>>")]
    place: PlaceFields<'a>,
    /// The judgement of the answer; null when nothing is answered here.
    answer: Option<AnswerRow<'a>>,
    /// The quoted numbers.
    quotes: Vec<QuoteRow<'a>>,
    /// The closed forms.
    closed_forms: Vec<ClosedFormRow<'a>>,
    /// The runs.
    runs: Vec<RunRow<'a>>,
    /// Every measure, under the name that its author gave it.
    #[schemars(with = "BTreeMap<String, MeasureRow>")]
    measures: Map<String, Value>,
}

/// A closed form.
#[derive(Serialize, JsonSchema)]
struct ClosedFormRow<'a> {
    /// The trace that should follow it.
    trace: &'a str,
    /// What became of it.
    #[schemars(extend("enum" = words_of_closed_forms()))]
    state: String,
    /// Why it is not true; else empty.
    reason: &'a str,
}

/// The states of closed forms: those of all claims, before a baseline is applied.
fn words_of_closed_forms() -> Vec<String> {
    let baselined = key(State::Baselined.as_str());
    State::list_words().into_iter().filter(|word| *word != baselined).collect()
}

/// A run of a `verify` object.
#[derive(Serialize, JsonSchema)]
struct RunRow<'a> {
    /// Its name.
    name: &'a str,
    /// How it broke; null when it did not.
    broke: Option<&'a str>,
    /// It is meant to break.
    expected: bool,
}

fn claim<'a>(claim: &'a Claim, c: &'a Checked) -> ClaimRow<'a> {
    let (j, file) = (&claim.judgement, &c.lesson.file);
    let form = j.exact.iter();
    let run = j.runs.iter();
    ClaimRow {
        name: &claim.name,
        place: PlaceFields::new(&[file], file.path(), &claim.span),
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

/// The judgement of a question.
#[derive(Serialize, JsonSchema)]
struct AnswerRow<'a> {
    /// What became of the keyed answer.
    #[schemars(extend("enum" = Verdict::ALL.map(Verdict::as_str)))]
    verdict: &'static str,
    /// A sentence that says why; empty when there is nothing to add.
    reason: &'a str,
    /// Every condition.
    options: Vec<OptionRow>,
}

/// How a condition held. Numbers are in the unit of the comparison that decides it.
#[derive(Serialize, JsonSchema)]
struct OptionRow {
    /// The option, from 0; null for the value of a numeric question.
    option: Option<usize>,
    /// Whether the condition holds; null if the author marked the option as `undecided`.
    holds: Option<bool>,
    /// The margin of the deciding comparison, in its unit; negative if the condition does not hold; null without a comparison.
    #[schemars(with = "AnyNumber")]
    margin: Option<f64>,
    /// How much half and a quarter of the timestep, other integrators, a converged solver and a moved start change the margin; null
    /// where nothing was compared.
    #[schemars(with = "AnyNumber")]
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

/// A number that the text quotes.
#[derive(Serialize, JsonSchema)]
struct QuoteRow<'a> {
    /// The quote.
    text: &'a str,
    /// What became of the quote.
    #[schemars(extend("enum" = Quote::VERDICTS))]
    verdict: &'static str,
    /// Why it is not verified; else empty.
    reason: &'a str,
    /// What the simulation gives, in the unit of the text.
    #[schemars(with = "AnyNumber")]
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

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a panic is the report of a failed test
mod tests {
    use super::*;

    #[test]
    fn every_subject_is_counted() {
        let counts = serde_json::to_value(ClaimCounts::new(&Ledger::default())).unwrap();
        let keys: Vec<&String> = counts.as_object().unwrap().keys().collect();
        assert_eq!(keys, Subject::ALL.map(|subject| key(subject.as_str())).each_ref());
    }
}
