//! Measures of many runs of a lab: the same runs and measures as those of a `verify` object, without the tests of robustness.

use crate::error::error;
use crate::models::models;
use facade::bind::scene::Models;
use facade::check;
use facade::finding::Finding;
use facade::language::Languages;
use facade::lint::{ModelFolder, load_lesson};
use facade::run::StepVariant;
use facade::source::SourceFile;
use facade::threads;
use facade::verify::{BoundLab, BoundVerify, RenderedText, RunCache, check_verify, measure_only_run};
use pyo3::prelude::*;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Duration;

/// The measures of a run, or why it has none.
type Measured = Result<Vec<f64>, String>;

/// Performs the run of each text, a lab whose `verify` object has one run and the measures. Returns the values of the measures, or why
/// there are none, in the order of the texts, whatever the number of threads. Ctrl-C ends it between runs.
#[pyfunction]
#[pyo3(signature = (texts, models=None, workers=0))]
pub(crate) fn measure(
    py: Python<'_>,
    texts: Vec<String>,
    models: Option<&Bound<'_, PyAny>>,
    workers: usize,
) -> PyResult<Vec<(Vec<f64>, Option<String>)>> {
    let folder = self::models(models)?;
    let cores = thread::available_parallelism().map_or(1, usize::from);
    let count = if workers == 0 { cores } else { workers }.min(texts.len()).max(1);
    let results: Vec<Mutex<Option<Measured>>> = texts.iter().map(|_| Mutex::new(None)).collect();
    let (next, stopped) = (AtomicUsize::new(0), AtomicBool::new(false));
    let work = || {
        let models = Models::new(folder.clone());
        while !stopped.load(Ordering::Relaxed) {
            let i = next.fetch_add(1, Ordering::Relaxed);
            let (Some(text), Some(result)) = (texts.get(i), results.get(i)) else { return };
            let measured = threads::catch_panic(|| measure_one(text, &models))
                .unwrap_or_else(|panic| Err(format!("labspec failed: {panic}; report it with this lab")));
            *result.lock().unwrap_or_else(PoisonError::into_inner) = Some(measured);
        }
    };
    py.detach(|| {
        thread::scope(|scope| {
            let spawn = |_| threads::checking().spawn_scoped(scope, work);
            let running: Vec<_> = (0..count).map(spawn).collect::<Result<_, _>>().map_err(|e| {
                stopped.store(true, Ordering::Relaxed);
                error("thread", &format!("cannot start a thread: {e}"), &[])
            })?;
            while running.iter().any(|worker| !worker.is_finished()) {
                thread::sleep(Duration::from_millis(2));
                if let Err(signal) = Python::attach(|py| py.check_signals()) {
                    stopped.store(true, Ordering::Relaxed);
                    return Err(signal);
                }
            }
            Ok(())
        })
    })?;
    let result =
        |cell: Mutex<Option<Measured>>| match cell.into_inner().unwrap_or_else(PoisonError::into_inner) {
            Some(Ok(values)) => (values, None),
            Some(Err(why)) => (Vec::new(), Some(why)),
            None => (Vec::new(), Some("it was not run".to_string())),
        };
    Ok(results.into_iter().map(result).collect())
}

fn measure_one(text: &str, models: &Models) -> Measured {
    let lesson = load_lesson(SourceFile::new("lab.json", text), models.folder());
    let mut findings: Vec<Finding> = lesson.findings.clone();
    let measured = || -> Option<Vec<f64>> {
        let addressed = lesson.addressed();
        let (_, lab) = addressed.first()?;
        let verify = lab.verify.as_ref()?;
        let (model, programs, _) = check::bind(lab, models, &mut findings)?;
        if findings.iter().any(Finding::is_error) {
            return None;
        }
        let stage = RunCache::new(models, Languages::ALL);
        let base = BoundLab::new(lab, &model, &programs);
        let scenes = stage.of_run(&base, verify.runs.first()?, &mut findings)?;
        let bound = BoundVerify::new(verify, Some(&base), &[scenes], &stage, &mut findings)?;
        let values = measure_only_run(&bound, StepVariant::NOMINAL);
        if values.is_none() {
            // The check says why.
            let rendered = RenderedText::of_lesson(&lesson);
            check_verify(&bound, verify, None, &rendered, &mut findings);
        }
        values
    }();
    let first = || findings.iter().find(|f| f.is_error()).map(|f| f.message.clone());
    measured
        .ok_or_else(|| first().unwrap_or_else(|| "the run breaks, so its measures say nothing".to_string()))
}

/// The JSON of a lab of a lesson, by its address.
#[pyfunction]
pub(crate) fn lab_json(path: &str, text: &str, address: &str) -> PyResult<String> {
    let lesson = load_lesson(SourceFile::new(path, text), &ModelFolder::unknown());
    let found = lesson
        .addressed()
        .into_iter()
        .find(|(lab_address, _)| format!("#{}", lab_address.to_string().trim_start_matches('#')) == address);
    let (_, lab) = found.ok_or_else(|| error("unknown-lab", &format!("{path} has no lab {address}"), &[]))?;
    Ok(lesson.file.slice(lab.span.clone()).to_string())
}
