//! The claims of a lesson with the numbers of another engine: the runs that it has to make, and the comparison with its results.

use crate::background;
use crate::models::models;
use crate::report::finding_dict;
use facade::bind::scene::Models;
use facade::check::{self, CrossCheck, ReferenceRecording};
use facade::finding::{Finding, InFile};
use facade::lint::{ModelFolder, load_lesson};
use facade::report::to_value;
use facade::source::SourceFile;
use facade::verify::judge::RecordedRun;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use std::collections::{BTreeMap, BTreeSet};
use std::hash::{DefaultHasher, Hasher};

/// A run: its claim, its name, its key, and the task as JSON, or the reason why another engine cannot make it.
type RequestRow = (String, String, String, Option<String>, Option<String>);

/// The results of a run.
#[derive(FromPyObject)]
pub(crate) struct RunResults {
    #[pyo3(item)]
    values: BTreeMap<String, f64>,
    #[pyo3(item)]
    refused: BTreeMap<String, String>,
    #[pyo3(item)]
    warnings: usize,
    #[pyo3(item)]
    broke: Option<String>,
}

/// The key of a run, for the results of this process.
fn key_of(parts: &[&[u8]]) -> String {
    let mut hasher = DefaultHasher::new();
    parts.iter().for_each(|part| hasher.write(part));
    format!("{:016x}", hasher.finish())
}

fn compared(
    (path, text): (&str, &str),
    folder: ModelFolder,
    recording: Option<&ReferenceRecording>,
) -> (CrossCheck, Vec<Finding>) {
    let models = Models::new(folder);
    let lesson = load_lesson(SourceFile::new(path, text), models.folder());
    let mut findings = Vec::new();
    let cross_check = check::cross_check(&lesson, &models, key_of, recording, &mut findings);
    (cross_check, findings.into_iter().map(|f| f.at(&lesson.file)).collect())
}

/// The runs of all claims of a lesson.
#[pyfunction]
#[pyo3(signature = (path, text, models=None))]
pub(crate) fn claimed_runs(
    py: Python<'_>,
    path: &str,
    text: &str,
    models: Option<&Bound<'_, PyAny>>,
) -> PyResult<Vec<RequestRow>> {
    let folder = self::models(models)?;
    let (cross_check, _) = background::run(py, None, |_| compared((path, text), folder, None))?;
    let row = |r: check::Request| {
        let (task, refused) = match r.task {
            Ok(task) => (Some(to_value(&task).to_string()), None),
            Err(reason) => (None, Some(reason)),
        };
        (r.claim, r.run, r.hash, task, refused)
    };
    Ok(cross_check.requests.into_iter().map(row).collect())
}

/// Compares all claims of a lesson with the results of another engine, by the keys of the runs. Returns a dictionary for each claim, and
/// the findings about verdicts that depend on the engine.
#[pyfunction]
#[pyo3(signature = (path, text, engine, results, models=None))]
pub(crate) fn cross_check<'py>(
    py: Python<'py>,
    path: &str,
    text: &str,
    engine: String,
    results: BTreeMap<String, RunResults>,
    models: Option<&Bound<'py, PyAny>>,
) -> PyResult<(Bound<'py, PyList>, Bound<'py, PyList>)> {
    let folder = self::models(models)?;
    let recorded = |(key, run): (String, RunResults)| {
        let RunResults { values, refused, warnings, broke } = run;
        (key, RecordedRun { values, refused, warnings, broke, without_value: BTreeMap::new() })
    };
    let runs = results.into_iter().map(recorded).collect();
    let recording = ReferenceRecording { engine, runs, recorded: BTreeSet::new() };
    let (cross_check, findings) =
        background::run(py, None, |_| compared((path, text), folder, Some(&recording)))?;
    let claims = PyList::empty(py);
    for (owner, judged) in &cross_check.claims {
        let dict = PyDict::new(py);
        dict.set_item("owner", owner)?;
        dict.set_item("compared", judged.compared)?;
        dict.set_item("verdicts", judged.claims)?;
        dict.set_item("turned", judged.turned)?;
        let differing: Vec<_> =
            judged.differing.iter().map(|d| (&d.name, d.labspec_value, d.reference_value)).collect();
        dict.set_item("differing", differing)?;
        dict.set_item("unjudged", judged.unjudged.clone())?;
        claims.append(dict)?;
    }
    let list = PyList::empty(py);
    for finding in &findings {
        list.append(finding_dict(py, finding)?)?;
    }
    Ok((claims, list))
}
