//! Errors: `LabspecError` with the code of the error, and the findings if there are any.

use crate::report::finding_dict;
use facade::finding::Finding;
use pyo3::create_exception;
use pyo3::exceptions::PyException;
use pyo3::prelude::*;
use pyo3::types::PyList;

create_exception!(
    labspec,
    LabspecError,
    PyException,
    "What labspec refuses. `code` names the kind of the error, and `findings` lists what is wrong in a lab or a model."
);

/// An error with a code and findings.
pub(crate) fn error(code: &str, message: &str, findings: &[Finding]) -> PyErr {
    Python::attach(|py| {
        let error = LabspecError::new_err(message.to_string());
        let described = || -> PyResult<()> {
            let value = error.value(py);
            let list = PyList::empty(py);
            for finding in findings {
                list.append(finding_dict(py, finding)?)?;
            }
            value.setattr("code", code)?;
            value.setattr("findings", list)
        };
        match described() {
            Ok(()) => error,
            Err(other) => other,
        }
    })
}

/// An error of the library.
pub(crate) fn refused(e: &facade::Error) -> PyErr {
    let findings = e.findings();
    error(findings.first().map_or("call", |finding| finding.code), &e.to_string(), findings)
}

/// An error of the engine.
pub(crate) fn refused_by_engine(e: &labspec_core::Error) -> PyErr {
    let code = e.diagnostics().first().map_or("call", |finding| finding.code);
    error(code, &e.to_string(), e.diagnostics())
}
