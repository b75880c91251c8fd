//! The common parts of all JSON reports: the head, locations, and the names of numbers that JSON cannot represent; and reports
//! in files that a later run reads.

use super::common::Failure;
use super::output::write_file;
use super::output_kind::OutputKind;
use super::schema_words::AnyNumber;
use super::stdio::print_json;
use labspec::report::{self, SCHEMA_VERSION, printable, printable_path};
use labspec::source::read_text;
use labspec::verify::Measured;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use std::borrow::Cow;
use std::marker::PhantomData;
use std::path::Path;

/// A report with its head.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct VersionedReport<'a, T> {
    schema_version: u32,
    report: &'a str,
    #[serde(flatten)]
    entries: &'a T,
}

/// The head of a file.
#[derive(Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
struct ReportHead {
    schema_version: Value,
    report: Value,
}

/// A report with its head, as a value.
pub(super) fn versioned(name: &str, entries: &impl Serialize) -> Value {
    report::to_value(&VersionedReport { schema_version: SCHEMA_VERSION, report: name, entries })
}

/// Prints a report.
pub(super) fn print_report(name: &str, entries: &impl Serialize) -> Result<(), Failure> {
    print_json(&VersionedReport { schema_version: SCHEMA_VERSION, report: name, entries }, true)
}

/// The kind of a report that a later run reads.
pub(super) struct StoredReport {
    /// Its name in the head.
    pub(super) name: &'static str,
    /// Its description with an article.
    pub(super) what: &'static str,
    /// What to do if a file is not such a report.
    pub(super) next_step: &'static str,
    pub(super) output: OutputKind<'static>,
}

/// The maximum size of a stored report in bytes.
const MAX_REPORT: u64 = 64 << 20;
/// The maximum length of an error message of the parser, which may quote the file.
const MOST_QUOTED: usize = 200;

/// Reads a stored report.
///
/// # Errors
/// The file cannot be read, or is not such a report.
pub(super) fn read_report<T: DeserializeOwned>(path: &Path, stored: &StoredReport) -> Result<T, Failure> {
    let no =
        |why: &str| format!("{} is not {}: {why}; {}", printable_path(path), stored.what, stored.next_step);
    let invalid =
        |e: serde_json::Error| no(&printable(&e.to_string().chars().take(MOST_QUOTED).collect::<String>()));
    let text = read_text(path, MAX_REPORT, stored.what)?;
    // The head is parsed first, because the content depends on the version.
    let head: ReportHead = serde_json::from_str(&text).map_err(invalid)?;
    if head.report != stored.name || head.schema_version != SCHEMA_VERSION {
        return Err(no("its version is missing or unsupported"));
    }
    serde_json::from_str(&text).map_err(invalid)
}

/// Writes a report for a later run atomically.
///
/// # Errors
/// The file cannot be written.
pub(super) fn write_report(
    path: &Path,
    stored: &StoredReport,
    entries: &impl Serialize,
) -> Result<(), Failure> {
    let report = VersionedReport { schema_version: SCHEMA_VERSION, report: stored.name, entries };
    let text = serde_json::to_string_pretty(&report).map_err(|e| e.to_string())?;
    write_file(path, stored.output, &(text + "\n"))
}

/// An object with these entries.
pub(super) fn object<T: Serialize>(entries: impl Iterator<Item = (String, T)>) -> Map<String, Value> {
    entries.map(|(key, value)| (key, serde_json::to_value(value).unwrap_or_default())).collect()
}

/// The names of numbers that JSON cannot represent, by key: `NaN`, `Infinity`, `-Infinity`; for a list,
/// pairs of index and name.
pub(super) type NonFinite = Map<String, Value>;

/// A number, an optional number, or a list of these.
pub(super) trait Numbers {
    /// The names of those numbers that JSON cannot represent.
    fn names(&self) -> Option<Value>;
}

impl Numbers for f64 {
    fn names(&self) -> Option<Value> {
        report::nonfinite(*self).map(Value::from)
    }
}

impl Numbers for Option<f64> {
    fn names(&self) -> Option<Value> {
        self.as_ref()?.names()
    }
}

impl<const N: usize> Numbers for [Option<f64>; N] {
    fn names(&self) -> Option<Value> {
        self.to_vec().names()
    }
}

impl Numbers for Vec<Option<f64>> {
    fn names(&self) -> Option<Value> {
        let named = |(i, x): (usize, &Option<f64>)| Some(Value::Array(vec![i.into(), x.names()?]));
        let names: Vec<Value> = self.iter().enumerate().filter_map(named).collect();
        (!names.is_empty()).then_some(Value::Array(names))
    }
}

/// The names of those of several numbers that JSON cannot represent.
pub(super) fn nonfinite(numbers: &[(&str, &dyn Numbers)]) -> NonFinite {
    numbers.iter().filter_map(|(key, x)| Some((key.to_string(), x.names()?))).collect()
}

/// A row of this type, with the names of those of its numbers that JSON cannot represent.
#[derive(Serialize)]
#[serde(transparent)]
pub(super) struct WithNonfinite<T> {
    entries: Map<String, Value>,
    #[serde(skip)]
    row: PhantomData<T>,
}

impl<T: JsonSchema> JsonSchema for WithNonfinite<T> {
    fn schema_name() -> Cow<'static, str> {
        T::schema_name()
    }

    fn schema_id() -> Cow<'static, str> {
        T::schema_id()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        T::json_schema(generator)
    }
}

/// A row with these numbers. `nonfinite` follows the first of them that JSON cannot represent.
pub(super) fn with_nonfinite<T: Serialize>(row: &T, numbers: &[(&str, &dyn Numbers)]) -> WithNonfinite<T> {
    let mut names = Some(nonfinite(numbers));
    let mut all = Map::new();
    if let Ok(Value::Object(row)) = serde_json::to_value(row) {
        for (key, value) in row {
            let names = names.take_if(|names| names.contains_key(&key));
            all.insert(key, value);
            all.extend(names.map(|names| ("nonfinite".to_string(), names.into())));
        }
    }
    WithNonfinite { entries: all, row: PhantomData }
}

/// The number, if JSON can represent it.
pub(super) fn finite(x: f64) -> Option<f64> {
    x.is_finite().then_some(x)
}

/// A measure.
#[derive(Debug, Serialize, Deserialize, JsonSchema)]
pub(super) struct MeasureRow {
    /// Its value.
    #[schemars(with = "AnyNumber")]
    pub(super) value: Option<f64>,
    /// Its value at half the timestep; null when that was not run.
    #[schemars(with = "AnyNumber")]
    halved: Option<f64>,
    #[serde(default, skip_serializing_if = "NonFinite::is_empty")]
    pub(super) nonfinite: NonFinite,
}

impl MeasureRow {
    pub(super) fn new(m: &Measured) -> MeasureRow {
        let nonfinite = nonfinite(&[("value", &m.value), ("halved", &m.halved)]);
        MeasureRow { value: finite(m.value), halved: m.halved.and_then(finite), nonfinite }
    }
}
