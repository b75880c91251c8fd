//! The JSON Schemas of all reports. Each is derived from the type that is written; `labspec reference` writes them to
//! `docs/schema`.

use super::machine::CheckReport;
use super::plan::PlanOutput;
use super::precision::PrecisionReport;
use super::reproduction::ReproductionRecord;
use super::scaffold::ScaffoldReport;
use super::schema_shape::finish;
use super::snapshot::SnapshotReport;
use super::stability::StabilityReport;
use super::trace::TraceReport;
use labspec::report::{RunReport, SCHEMA_VERSION};
use labspec_developer::bench::StepTime;
use labspec_developer::record::EngineRecording;
use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use serde_json::{Map, Value, json};

/// File name and text of the schema of each report.
pub(super) fn schemas() -> Vec<(String, String)> {
    let all = [
        ("bench", report_schema::<StepTime>("labspec bench", &["bench"])),
        ("check", report_schema::<CheckReport<'_>>("labspec check --format json", &["check", "verify"])),
        ("plan", report_schema::<PlanOutput<'_>>("labspec plan --format json", &["plan"])),
        (
            "precision",
            report_schema::<PrecisionReport<'_>>("labspec precision --format json", &["precision"]),
        ),
        ("record", report_schema::<EngineRecording>("labspec record", &["record"])),
        ("run", report_schema::<RunReport>("labspec run --format json", &["run"])),
        ("scaffold", report_schema::<ScaffoldReport<'_>>("labspec scaffold --format json", &["scaffold"])),
        ("snapshot", report_schema::<SnapshotReport<'_>>("labspec snapshot --format json", &["snapshot"])),
        (
            "stability",
            report_schema::<StabilityReport<'_>>("labspec stability --format json", &["stability"]),
        ),
        ("trace", report_schema::<TraceReport<'_>>("labspec trace --format json", &["trace"])),
        ("verify", verify_schema()),
    ];
    let record = report_schema::<ReproductionRecord>("labspec check --record FILE", &["reproduction"]);
    let of_reports = all.into_iter().map(|(name, schema)| (format!("report-{name}.json"), schema));
    let files = of_reports.chain([("reproduction.json".to_string(), record)]);
    files.map(|(name, schema)| (name, format!("{schema:#}\n"))).collect()
}

/// The schema of a report with these names. Its description is the documentation of the type of its entries.
fn report_schema<T: JsonSchema>(title: &str, names: &[&str]) -> Value {
    let generator = SchemaSettings::draft2020_12().for_serialize().into_generator();
    let mut schema = generator.into_root_schema_for::<T>();
    schema.insert("title".into(), title.into());
    let name = match names {
        [name] => json!({"description": "The name of this report.", "const": name}),
        names => json!({"description": "The name of this report.", "enum": names}),
    };
    let version = json!({"description": "The version of the form of all reports.", "const": SCHEMA_VERSION});
    let head = [("schemaVersion", version), ("report", name)];
    // The head comes first, as in the report.
    if let Some(Value::Array(required)) = schema.get_mut("required") {
        required.retain(|key| head.iter().all(|(of_head, _)| key != of_head));
        required.splice(0..0, head.iter().map(|(key, _)| Value::from(*key)));
    }
    if let Some(Value::Object(properties)) = schema.get_mut("properties") {
        let mut all: Map<String, Value> =
            head.into_iter().map(|(key, of_head)| (key.into(), of_head)).collect();
        for (key, property) in std::mem::take(properties) {
            all.entry(key).or_insert(property);
        }
        *properties = all;
    }
    finish(schema)
}

/// The schema of the report `verify`, which is that of `check` with another name.
fn verify_schema() -> Value {
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "labspec verify --format json",
        "description": "The same as the report `check`, of claims only: labs are not run for their own sake.",
        "$ref": "report-check.json",
        "properties": {"report": {"const": "verify"}},
    })
}
