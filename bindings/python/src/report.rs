//! Findings and claims of a check, as dictionaries, of which the package makes objects.

use crate::background;
use crate::models::models;
use facade::Checker;
use facade::check::CheckLevel;
use facade::finding::Finding;
use facade::ledger::Entry;
use facade::listings::{Listing, pair_listings};
use facade::source::SourceFile;
use facade::spec::read_lesson;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use std::collections::BTreeMap;

/// A finding as a dictionary.
pub(crate) fn finding_dict<'py>(py: Python<'py>, f: &Finding) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("code", f.code)?;
    dict.set_item("severity", f.severity.as_str())?;
    dict.set_item("message", &f.message)?;
    dict.set_item("why", f.why.as_deref())?;
    dict.set_item("help", f.help.as_deref())?;
    dict.set_item("file", &*f.path)?;
    dict.set_item("line", f.position.map(|position| position.line))?;
    dict.set_item("column", f.position.map(|position| position.column))?;
    dict.set_item("start", f.span.start)?;
    dict.set_item("end", f.span.end)?;
    dict.set_item("owner", f.claim.as_ref().map(|claim| claim.owner.as_str()))?;
    Ok(dict)
}

fn claim_dict<'py>(py: Python<'py>, e: &Entry) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("owner", &e.owner)?;
    dict.set_item("subject", e.subject.as_str())?;
    dict.set_item("state", e.state.as_str())?;
    dict.set_item("word", e.word)?;
    dict.set_item("part", &e.what)?;
    dict.set_item("remark", &e.remark)?;
    dict.set_item("start", e.span.start)?;
    dict.set_item("end", e.span.end)?;
    Ok(dict)
}

/// The outcome in a word, the findings, the claims, and the JSON of the lesson as `labspec check --format json` prints it.
type CheckResults<'py> = (&'static str, Bound<'py, PyList>, Bound<'py, PyList>, String);

/// Checks a lesson. `path` names the file for messages, and its extension decides how it is read. `related` are the texts of other lessons
/// by path. The level is "full", "claims" (only the claims are verified) or "static" (nothing is simulated).
#[pyfunction]
#[pyo3(signature = (path, text, models=None, related=None, level="full", progress=None))]
pub(crate) fn check<'py>(
    py: Python<'py>,
    path: &str,
    text: &str,
    models: Option<&Bound<'py, PyAny>>,
    related: Option<BTreeMap<String, String>>,
    level: &str,
    progress: Option<Py<PyAny>>,
) -> PyResult<CheckResults<'py>> {
    let level = match level {
        "full" => CheckLevel::FULL,
        "claims" => CheckLevel::CLAIMS,
        "static" => CheckLevel::STATIC,
        other => return Err(PyValueError::new_err(format!("the level \"{other}\" is unknown"))),
    };
    let mut checker = Checker::new(self::models(models)?).level(level);
    if let Some(texts) = related {
        checker = checker.neighbours(texts);
    }
    let report = background::run(py, progress, |_| checker.check(path, text))?;
    let findings = PyList::empty(py);
    for finding in &report.findings {
        findings.append(finding_dict(py, finding)?)?;
    }
    let claims = PyList::empty(py);
    for entry in report.entries() {
        claims.append(claim_dict(py, entry)?)?;
    }
    let lesson = labspec_cli::lesson_report(&report.checked).to_string();
    Ok((report.outcome().as_str(), findings, claims, lesson))
}

/// The Python listings of a lesson that have an output: the name of each in the ledger, its first line, and the last line of its output.
/// Nothing is run.
#[pyfunction]
pub(crate) fn listings(path: &str, text: &str) -> Vec<(String, usize, usize)> {
    let lesson = read_lesson(SourceFile::new(path, text));
    let line = |offset: usize| lesson.file.position(offset).line;
    let describe =
        |listing: &Listing<'_>| (listing.name(), line(listing.info.start), line(listing.span().end));
    pair_listings(&lesson).iter().map(describe).collect()
}
