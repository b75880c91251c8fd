//! Precision and stability of a lab: the reports of `labspec precision` and `labspec stability`.

use crate::background;
use crate::error::error;
use crate::models::models;
use crate::source::{LabSource, OpenedLab, open};
use facade::Value;
use facade::run::{INTEGRATORS, Integrator};
use labspec_cli::{LabReport, precision_report, stability_report};
use labspec_numerics::precision::{PrecisionOptions, VariedSetting, compare};
use labspec_numerics::stability::{StressOptions, probe};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;

/// The JSON of a report, and its chart as SVG.
type ReportTexts = (String, Option<String>);

/// The controls that are set before every run, and the buttons that are pressed, with their times in s.
#[derive(FromPyObject)]
pub(crate) struct Interactions<'py> {
    #[pyo3(item)]
    pub(crate) until: Option<f64>,
    #[pyo3(item)]
    set: Vec<(String, Bound<'py, PyAny>)>,
    #[pyo3(item)]
    pub(crate) press: Vec<(String, f64)>,
}

impl Interactions<'_> {
    pub(crate) fn values(&self) -> PyResult<Vec<(String, Value)>> {
        self.set.iter().map(|(label, value)| Ok((label.clone(), control_value(value)?))).collect()
    }
}

/// The value for a control.
pub(crate) fn control_value(value: &Bound<'_, PyAny>) -> PyResult<Value> {
    if let Ok(b) = value.extract::<bool>() {
        Ok(Value::Boolean(b))
    } else if let Ok(x) = value.extract::<f64>() {
        Ok(Value::Number(x))
    } else if let Ok(text) = value.extract::<String>() {
        Ok(Value::String(text.into()))
    } else {
        Err(PyTypeError::new_err("a control has a number, a text or a boolean"))
    }
}

/// Compares the error and the run time of integrators and timesteps.
#[pyfunction]
#[pyo3(signature = (source, models, given, integrators, vary, progress=None))]
pub(crate) fn precision(
    py: Python<'_>,
    source: LabSource,
    models: Option<&Bound<'_, PyAny>>,
    given: Interactions<'_>,
    integrators: Vec<String>,
    vary: Vec<String>,
    progress: Option<Py<PyAny>>,
) -> PyResult<ReportTexts> {
    let options = PrecisionOptions {
        until: given.until,
        set: given.values()?,
        press: given.press,
        integrators: integrators_named(&integrators)?,
        axes: vary.iter().map(|name| varied_setting(name)).collect::<PyResult<_>>()?,
        beside: None,
    };
    let OpenedLab { lab, model, programs } = open(&source, self::models(models)?)?;
    let mut findings = Vec::new();
    let results = background::run(py, progress, |report| {
        let results = compare(&lab, &model, &programs, &options, &mut findings, report);
        results.map(|results| precision_report(&results, lab.title())).map_err(|e| e.to_string())
    })?;
    if let Some(f) = findings.first() {
        return Err(error(f.code, &format!("a closed form has an error: {}", f.message), &findings));
    }
    texts(results)
}

/// Finds what breaks when a student moves the controls in every way.
#[pyfunction]
#[pyo3(signature = (source, models, given, margins=false, map=None, progress=None))]
pub(crate) fn stability(
    py: Python<'_>,
    source: LabSource,
    models: Option<&Bound<'_, PyAny>>,
    given: Interactions<'_>,
    margins: bool,
    map: Option<[String; 2]>,
    progress: Option<Py<PyAny>>,
) -> PyResult<ReportTexts> {
    let set = given.values()?;
    let options = StressOptions { until: given.until, margins, map, set, press: given.press };
    let OpenedLab { lab, model, programs } = open(&source, self::models(models)?)?;
    let results = background::run(py, progress, |report| {
        let results = probe(&lab, &model, &programs, &options, report);
        results.map(|found| stability_report(&found, &programs, lab.title())).map_err(|e| e.to_string())
    })?;
    texts(results)
}

fn texts(report: Result<LabReport, String>) -> PyResult<ReportTexts> {
    let report = report.map_err(|e| error("call", &e, &[]))?;
    Ok((report.json.to_string(), report.chart))
}

fn integrators_named(names: &[String]) -> PyResult<Vec<Integrator>> {
    if names.iter().any(|name| name == "all") {
        return Ok(INTEGRATORS.to_vec());
    }
    let one = |name: &String| {
        Integrator::named(name).ok_or_else(|| {
            let names = INTEGRATORS.map(|i| i.name).join(", ");
            PyValueError::new_err(format!("the integrator \"{name}\" is unknown: use one of {names}, or all"))
        })
    };
    names.iter().map(one).collect()
}

fn varied_setting(name: &str) -> PyResult<VariedSetting> {
    match name {
        "iterations" => Ok(VariedSetting::Iterations),
        "tolerance" => Ok(VariedSetting::Tolerance),
        "cone" => Ok(VariedSetting::Cone),
        other => Err(PyValueError::new_err(format!(
            "the setting \"{other}\" is unknown: use one of iterations, tolerance, cone"
        ))),
    }
}
