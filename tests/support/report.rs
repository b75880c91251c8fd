//! The checks of every JSON output that a test receives: it is a report, and it conforms to the published schema.

use super::schema::{problems, schemas};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::OnceLock;

/// Checks an output against its schema, if it is JSON.
pub(crate) fn hold(printed: &str) {
    if printed.starts_with('{') {
        let report = serde_json::from_str(printed).unwrap_or_else(|e| panic!("{e} in\n{printed:.2000}"));
        check_report_value(&report);
    }
}

/// Checks the outputs of a command. Commands that print JSON must have printed a report.
pub(crate) fn check_command_outputs(folder: &Path, arguments: &[&str], code: i32, printed: &str) {
    let asked = |option: &str, value: &str| arguments.windows(2).any(|pair| pair == [option, value]);
    let always = matches!(arguments.first(), Some(&("bench" | "record")));
    if (always || asked("--format", "json")) && matches!(code, 0 | 1 | 130) {
        assert!(printed.starts_with('{'), "{arguments:?} prints no report:\n{printed:.2000}");
    }
    // Formats of other programs have separate schemas.
    if !["jsonl", "sarif", "gitlab"].iter().any(|form| asked("--format", form)) {
        hold(printed);
    }
    // The report that was written to a file.
    let file = arguments.iter().position(|a| *a == "--json").and_then(|i| arguments.get(i + 1));
    if let Some(file) = file.filter(|_| code < 2) {
        hold(&std::fs::read_to_string(folder.join(file)).unwrap());
    }
}

pub(crate) fn check_report_value(report: &Value) {
    static SCHEMAS: OnceLock<BTreeMap<String, Value>> = OnceLock::new();
    let first: Vec<&String> = report.as_object().unwrap().keys().take(2).collect();
    assert_eq!(first, ["schemaVersion", "report"], "{report:.2000}");
    let file = format!("report-{}.json", report["report"].as_str().unwrap());
    let mut wrong = problems(SCHEMAS.get_or_init(schemas), &file, report);
    named_numbers(report, "", &mut wrong);
    columns(report, &mut wrong);
    assert!(wrong.is_empty(), "{file}:\n{}\nin\n{report:.4000}", wrong.join("\n"));
}

/// Every value that `nonfinite` names is `null`.
fn named_numbers(value: &Value, at: &str, wrong: &mut Vec<String>) {
    match value {
        Value::Array(items) => {
            items.iter().enumerate().for_each(|(i, v)| named_numbers(v, &format!("{at}/{i}"), wrong));
        }
        Value::Object(entries) => {
            for (key, names) in entries.get("nonfinite").and_then(Value::as_object).into_iter().flatten() {
                let mut places = vec![format!("/{key}")];
                if let Some(list) = names.as_array() {
                    let place = |entry: &Value| {
                        let all = entry.as_array().unwrap();
                        let path: String = all[..all.len() - 1].iter().map(|i| format!("/{i}")).collect();
                        format!("/{key}{path}")
                    };
                    places = list.iter().map(place).collect();
                }
                let lost = |p: &&String| value.pointer(p) == Some(&Value::Null);
                wrong.extend(places.iter().filter(|p| !lost(p)).map(|p| format!("{at}{p} is not null")));
                if places.is_empty() {
                    wrong.push(format!("{at}/nonfinite/{key} is empty"));
                }
            }
            entries.iter().for_each(|(k, v)| named_numbers(v, &format!("{at}/{k}"), wrong));
        }
        _ => {}
    }
}

/// Each row of a table has one entry per column, and all entries of a column have its type.
fn columns(report: &Value, wrong: &mut Vec<String>) {
    let Some(types) = report["types"].as_array() else { return };
    let rows = report["rows"].as_array().unwrap();
    let fits = |cell: &Value, of: &Value| match cell {
        Value::Null => true,
        Value::Number(_) => of == "number",
        Value::Bool(_) => of == "boolean",
        _ => of == "text",
    };
    let whole = |row: &[Value]| row.len() == types.len() && row.iter().zip(types).all(|(c, t)| fits(c, t));
    let bad = rows.iter().enumerate().filter(|(_, row)| !whole(row.as_array().unwrap()));
    wrong.extend(bad.map(|(i, row)| format!("/rows/{i}: {row} is not of {types:?}")));
    if report["columns"].as_array().map(Vec::len) != Some(types.len()) {
        wrong.push("there are not as many types as columns".into());
    }
}
