//! The reports of the program for programs that contain it: the JSON of `--format json`, and the charts.

use super::report_json::versioned;
use super::{machine, precision, stability};
use labspec::bind::Programs;
use labspec::check::Checked;
use labspec::report::to_value;
use labspec_numerics::precision::PrecisionResults;
use labspec_numerics::stability::StressReport;
use serde_json::Value;

/// A report about a lab.
#[derive(Debug)]
pub struct LabReport {
    /// The output with `--format json`.
    pub json: Value,
    /// The chart with `--svg`; `None` if there is nothing to draw.
    pub chart: Option<String>,
}

/// The report of `labspec precision`.
pub fn precision_report(results: &PrecisionResults, title: &str) -> LabReport {
    let drawn = results.reference.is_some();
    LabReport {
        json: versioned("precision", &precision::machine(results)),
        chart: drawn.then(|| precision::chart(results, title)),
    }
}

/// The report of `labspec stability`.
pub fn stability_report(report: &StressReport, programs: &Programs, title: &str) -> LabReport {
    LabReport {
        json: versioned("stability", &stability::machine(report, programs)),
        chart: report.map.as_ref().map(|map| stability::chart(map, title)),
    }
}

/// A lesson in the report of `labspec check`: the labs, and the claims with their runs and measures.
pub fn lesson_report(checked: &Checked) -> Value {
    to_value(&machine::lesson(checked))
}
