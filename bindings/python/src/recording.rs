//! A recorded run of a lab with given controls: the samples of `labspec run`.

use crate::background;
use crate::error::error;
use crate::fields::copied;
use crate::models::models;
use crate::numerics::Interactions;
use crate::source::{LabSource, OpenedLab, open};
use facade::run::{RunOptions, run};
use labspec_core::reflect;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// Runs a lab from its start with given controls. Returns a row for the start, for every `every` steps and for the end: the time, then the
/// displayed values as numbers. Ctrl-C ends it.
#[pyfunction]
#[pyo3(signature = (source, models, given, every=1))]
pub(crate) fn record_run<'py>(
    py: Python<'py>,
    source: LabSource,
    models: Option<&Bound<'py, PyAny>>,
    given: Interactions<'py>,
    every: usize,
) -> PyResult<Bound<'py, PyAny>> {
    if every == 0 {
        return Err(PyValueError::new_err("`every` must be at least 1 step"));
    }
    let options = RunOptions {
        until: given.until,
        set: given.values()?,
        press: given.press,
        every,
        ..RunOptions::default()
    };
    let OpenedLab { lab, model, programs } = open(&source, self::models(models)?)?;
    let table = background::run(py, None, |_| run(&lab, &model, &programs, &options))?;
    let table = table.map_err(|e| error("call", &e.to_string(), &[]))?;
    let rows: Vec<f64> = table.rows.iter().flatten().map(|cell| cell.number()).collect();
    copied(py, reflect::View::F64(&rows), &[table.rows.len(), table.columns.len()])
}
