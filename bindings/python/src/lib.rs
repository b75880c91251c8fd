//! labspec for Python: the module `labspec._labspec`, on which the package `labspec` builds.
//!
//! A thin layer over `labspec::Player`, `labspec::Checker` and the engine. Long calls release the interpreter. Fields are views of
//! the memory of the engine, which keep their model or data alive ([`fields`]).

mod background;
mod cross_check;
mod data;
mod error;
mod evaluator;
mod fields;
mod lab;
mod model;
mod models;
mod numerics;
mod program;
mod recording;
mod report;
mod source;
mod sweep;

#[pyo3::pymodule]
mod _labspec {
    #[pymodule_export]
    use crate::cross_check::{claimed_runs, cross_check};
    #[pymodule_export]
    use crate::data::Data;
    #[pymodule_export]
    use crate::error::LabspecError;
    #[pymodule_export]
    use crate::evaluator::Evaluator;
    #[pymodule_export]
    use crate::fields::{FieldView, field_docs};
    #[pymodule_export]
    use crate::lab::{Lab, LabState};
    #[pymodule_export]
    use crate::model::Model;
    #[pymodule_export]
    use crate::numerics::{precision, stability};
    #[pymodule_export]
    use crate::program::{run_program, runs_faster_build};
    #[pymodule_export]
    use crate::recording::record_run;
    #[pymodule_export]
    use crate::report::{check, listings};
    #[pymodule_export]
    use crate::sweep::{lab_json, measure};

    /// The version of the package.
    #[pymodule_export]
    const __VERSION__: &str = env!("CARGO_PKG_VERSION");
}
