//! Findings as JSON, for editors and pipelines.

use super::{Summary, file_of};
use crate::finding::Finding;
use crate::source::SourceFile;
use serde_json::{Value, json};
use std::ops::Range;

/// All findings and their counts. Lines and columns count from 1, columns in characters; an end is the place
/// behind the last character. Without the file of a finding among `files`, its places are `null`.
pub fn json(findings: &[Finding], files: &[&SourceFile]) -> Value {
    let summary = Summary::of(findings);
    json!({
        "findings": findings.iter().map(|f| one(f, files)).collect::<Vec<_>>(),
        "summary": {"errors": summary.errors, "warnings": summary.warnings, "notes": summary.notes},
    })
}

fn one(finding: &Finding, files: &[&SourceFile]) -> Value {
    let file = file_of(files, &finding.path);
    let mut value = json!({
        "code": finding.code,
        "severity": finding.severity.as_str(),
        "file": &*finding.path,
    });
    place(&mut value, file, &finding.span);
    value["message"] = json!(finding.message);
    value["why"] = json!(finding.why);
    value["help"] = json!(finding.help);
    value["fix"] = finding.fix.as_ref().map_or(Value::Null, |fix| {
        let mut value = json!({"text": fix.text});
        place(&mut value, file, &fix.span);
        value
    });
    value["related"] = finding
        .related
        .iter()
        .map(|related| {
            let mut value = json!({"file": &*related.path, "message": related.label});
            place(&mut value, file_of(files, &related.path), &related.span);
            value
        })
        .collect();
    value
}

fn place(value: &mut Value, file: Option<&SourceFile>, span: &Range<usize>) {
    let start = file.map(|f| f.position(span.start));
    let end = file.map(|f| f.position(span.end));
    value["line"] = json!(start.map(|p| p.line));
    value["column"] = json!(start.map(|p| p.column));
    value["end_line"] = json!(end.map(|p| p.line));
    value["end_column"] = json!(end.map(|p| p.column));
}
