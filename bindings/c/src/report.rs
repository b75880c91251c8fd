//! Findings and claims: of a check, of a lab, or of an error.

use crate::arguments::{VersionedStruct, c_string, check_pointer, pointer_to, store, text, write_struct};
use crate::handles::{self, Handle, NewHandle};
use crate::models::{GivenModels, ModelSource, Texts, related_texts};
use crate::status::{Failure, Outcome, Status, call};
use facade::Checker;
use facade::finding::Finding;
use facade::ledger::{self, Entry};
use serde_json::{Value as Json, json};
use std::ffi::{CString, c_char};

/// The findings and claims of a check. Also the findings of a lab or of the last error, then without claims.
pub struct CheckReport {
    _opaque: [u8; 0],
}

impl Handle for CheckReport {
    type Object = FindingReport;
    const NAME: &'static str = "labspec_check_report";
}

/// What a report contains, as C reads it. It does not change, so that pointers to its texts are valid as long as its handle.
pub(crate) struct FindingReport {
    outcome: CheckOutcome,
    findings: Vec<FindingTexts>,
    claims: Vec<ClaimTexts>,
    json: CString,
}

struct FindingTexts {
    severity: FindingSeverity,
    code: CString,
    file: CString,
    message: CString,
    why: Option<CString>,
    help: Option<CString>,
    line: usize,
    column: usize,
    start: usize,
    end: usize,
}

struct ClaimTexts {
    owner: CString,
    subject: CString,
    state: CString,
    word: CString,
    remark: CString,
}

/// The severity of a finding.
#[derive(Clone, Copy, PartialEq, Eq)]
#[repr(C)]
pub enum FindingSeverity {
    /// Something is broken or false.
    LabspecSeverityError = 0,
    /// Probably not what the author intended.
    LabspecSeverityWarning = 1,
    /// Useful information.
    LabspecSeverityNote = 2,
}

/// The outcome of a check.
#[derive(Clone, Copy, PartialEq, Eq)]
#[repr(C)]
pub enum CheckOutcome {
    /// Every claim was checked and is true. Never for findings without a check.
    LabspecOutcomeClean = 0,
    /// A claim is false, or could not be checked. Of findings without a check: there are some.
    LabspecOutcomeFindings = 1,
    /// Everything that was checked is true, and some claims were left out.
    LabspecOutcomePartial = 2,
    /// There was nothing to check.
    LabspecOutcomeNothing = 3,
}

/// A finding. Its texts are valid until the report is freed.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct ReportFinding {
    /// sizeof(labspec_finding), set by the caller.
    pub struct_size: usize,
    /// Its severity.
    pub severity: FindingSeverity,
    /// The code of its rule, such as "unknown-object".
    pub code: *const c_char,
    /// The file; empty if it is not known.
    pub file: *const c_char,
    /// What is wrong, without a full stop.
    pub message: *const c_char,
    /// Why it matters, or NULL.
    pub why: *const c_char,
    /// What to write instead, or NULL.
    pub help: *const c_char,
    /// The line, from 1; 0 if it is not known.
    pub line: usize,
    /// The column in characters, from 1; 0 if it is not known.
    pub column: usize,
    /// The byte offset of its start in the file.
    pub start: usize,
    /// The byte offset of its end in the file.
    pub end: usize,
}

// SAFETY: the size is the first field.
unsafe impl VersionedStruct for ReportFinding {
    const FIRST_SIZE: usize = std::mem::offset_of!(ReportFinding, end) + size_of::<usize>();
    const NAME: &'static str = "labspec_finding";
}

/// A claim of a lesson with its state. Its texts are valid until the report is freed.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct ReportClaim {
    /// sizeof(labspec_claim), set by the caller.
    pub struct_size: usize,
    /// The owner, such as "lab #1" or "quiz fall, question 2".
    pub owner: *const c_char,
    /// The kind of the claim, such as "answer" or "quoted number".
    pub subject: *const c_char,
    /// "true", "false", "unchecked", "left out", "known" or "not claimed".
    pub state: *const c_char,
    /// The state in one word, such as "verified".
    pub word: *const c_char,
    /// The reason or the coverage; may be empty.
    pub remark: *const c_char,
}

// SAFETY: the size is the first field.
unsafe impl VersionedStruct for ReportClaim {
    const FIRST_SIZE: usize = std::mem::offset_of!(ReportClaim, remark) + size_of::<*const c_char>();
    const NAME: &'static str = "labspec_claim";
}

impl FindingReport {
    /// A report of findings without a check.
    pub(crate) fn of_findings(findings: &[Finding]) -> FindingReport {
        let outcome = match findings.is_empty() {
            // No claim was checked.
            true => ledger::Outcome::Nothing,
            false => ledger::Outcome::Findings,
        };
        FindingReport::new(outcome, findings, &[])
    }

    fn new(outcome: ledger::Outcome, findings: &[Finding], entries: &[Entry]) -> FindingReport {
        let json = json!({
            "outcome": outcome.as_str(),
            "findings": findings.iter().map(finding_json).collect::<Vec<_>>(),
            "entries": entries.iter().map(entry_json).collect::<Vec<_>>(),
        });
        FindingReport {
            outcome: match outcome {
                ledger::Outcome::Clean => CheckOutcome::LabspecOutcomeClean,
                // Without a baseline, nothing is known from one.
                ledger::Outcome::Findings | ledger::Outcome::Baselined => {
                    CheckOutcome::LabspecOutcomeFindings
                }
                ledger::Outcome::Partial => CheckOutcome::LabspecOutcomePartial,
                ledger::Outcome::Nothing => CheckOutcome::LabspecOutcomeNothing,
            },
            findings: findings.iter().map(FindingTexts::new).collect(),
            claims: entries.iter().map(ClaimTexts::new).collect(),
            json: c_string(&json.to_string()),
        }
    }
}

impl FindingTexts {
    fn new(f: &Finding) -> FindingTexts {
        FindingTexts {
            severity: match f.severity {
                facade::finding::Severity::Error => FindingSeverity::LabspecSeverityError,
                facade::finding::Severity::Warning => FindingSeverity::LabspecSeverityWarning,
                facade::finding::Severity::Note => FindingSeverity::LabspecSeverityNote,
            },
            code: c_string(f.code),
            file: c_string(&f.path),
            message: c_string(&f.message),
            why: f.why.as_deref().map(c_string),
            help: f.help.as_deref().map(c_string),
            line: f.position.map_or(0, |p| p.line),
            column: f.position.map_or(0, |p| p.column),
            start: f.span.start,
            end: f.span.end,
        }
    }
}

impl ClaimTexts {
    fn new(e: &Entry) -> ClaimTexts {
        ClaimTexts {
            owner: c_string(&e.owner),
            subject: c_string(e.subject.as_str()),
            state: c_string(e.state.as_str()),
            word: c_string(e.word),
            remark: c_string(&e.remark),
        }
    }
}

/// The keys of the objects of the npm package.
fn finding_json(f: &Finding) -> Json {
    let fix = f.fix.as_ref().map(|fix| {
        json!({
            "text": fix.text, "applicability": fix.applicability.as_str(), "start": fix.span.start, "end": fix.span.end,
        })
    });
    json!({
        "code": f.code, "severity": f.severity.as_str(), "file": &*f.path, "start": f.span.start, "end": f.span.end,
        "line": f.position.map(|p| p.line), "column": f.position.map(|p| p.column),
        "message": f.message, "why": f.why, "help": f.help, "fix": fix,
    })
}

fn entry_json(e: &Entry) -> Json {
    json!({
        "owner": e.owner, "subject": e.subject.as_str(), "state": e.state.as_str(), "word": e.word, "remark": e.remark,
    })
}

/// Checks a lesson: lint, runs of its labs, verdicts on its claims. The extension of `path` determines the format, Markdown or
/// JSON; the file is not opened. `related` are lessons and snapshots that the lesson names, by their paths, or NULL. Mistakes of
/// the lesson are findings of the report, and the call succeeds.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_check(
    path: *const c_char,
    lesson: *const c_char,
    models: *const ModelSource,
    related: *const Texts,
    report: *mut *mut CheckReport,
) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe {
        let out = NewHandle::new(report)?;
        let (path, lesson) = (text(path, "the path")?, text(lesson, "the lesson")?);
        let mut checker = Checker::new(GivenModels::read(models)?.open()?);
        if let Some(texts) = related_texts(related)? {
            checker = checker.neighbours(texts);
        }
        let checked = checker.check(path, lesson);
        out.set(FindingReport::new(checked.outcome(), &checked.findings, checked.entries()))
    })
}

/// The outcome of the check.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_check_report_outcome(
    report: *const CheckReport,
    outcome: *mut CheckOutcome,
) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe { store(outcome, handles::find(report)?.outcome, "the pointer to the outcome") })
}

/// The number of findings.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_check_report_finding_count(
    report: *const CheckReport,
    count: *mut usize,
) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe { store(count, handles::find(report)?.findings.len(), "the pointer to the count") })
}

/// The finding with this index, from 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_check_report_finding(
    report: *const CheckReport,
    index: usize,
    finding: *mut ReportFinding,
) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe {
        let report = handles::find(report)?;
        check_pointer(finding, "the pointer to the finding")?;
        let f = item(&report.findings, index, "finding")?;
        let value = ReportFinding {
            struct_size: 0,
            severity: f.severity,
            code: f.code.as_ptr(),
            file: f.file.as_ptr(),
            message: f.message.as_ptr(),
            why: pointer_to(f.why.as_deref()),
            help: pointer_to(f.help.as_deref()),
            line: f.line,
            column: f.column,
            start: f.start,
            end: f.end,
        };
        write_struct(finding, &value)
    })
}

/// The number of claims; 0 for a report of findings alone.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_check_report_claim_count(
    report: *const CheckReport,
    count: *mut usize,
) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe { store(count, handles::find(report)?.claims.len(), "the pointer to the count") })
}

/// The claim with this index, from 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_check_report_claim(
    report: *const CheckReport,
    index: usize,
    claim: *mut ReportClaim,
) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe {
        let report = handles::find(report)?;
        check_pointer(claim, "the pointer to the claim")?;
        let c = item(&report.claims, index, "claim")?;
        let value = ReportClaim {
            struct_size: 0,
            owner: c.owner.as_ptr(),
            subject: c.subject.as_ptr(),
            state: c.state.as_ptr(),
            word: c.word.as_ptr(),
            remark: c.remark.as_ptr(),
        };
        write_struct(claim, &value)
    })
}

/// The report as JSON: an object with `outcome`, `findings` (code, severity, file, start, end, line, column, message, why, help,
/// fix) and `entries` (owner, subject, state, word, remark), as in the npm package. Valid until the report is freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_check_report_json(
    report: *const CheckReport,
    json: *mut *const c_char,
) -> Status {
    // SAFETY: the caller keeps the contract of the header.
    call(|| unsafe { store(json, handles::find(report)?.json.as_ptr(), "the pointer to the text") })
}

/// Frees a report. Does nothing for NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn labspec_check_report_free(report: *mut CheckReport) -> Status {
    call(|| handles::free(report))
}

pub(crate) fn item<'a, T>(list: &'a [T], index: usize, what: &str) -> Outcome<&'a T> {
    list.get(index).ok_or_else(|| Failure::index(what, index, list.len()))
}
