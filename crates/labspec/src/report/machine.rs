//! Reports for editors and pipelines, as JSON: what all of them have in common. `docs/reports.md` is their reference, and
//! `docs/schema` holds a JSON Schema of each.

use super::{Summary, file_of};
use crate::finding::Finding;
use crate::source::{EditorPosition, SourceFile};
use serde_json::{Value, json};
use std::ops::Range;

/// The version of the form of all reports. It goes up when a program that reads them would have to change.
pub const SCHEMA_VERSION: u32 = 1;

/// A report with this name: its version and its name stand first.
pub fn report(name: &str, entries: Value) -> Value {
    let mut all = json!({"schemaVersion": SCHEMA_VERSION, "report": name});
    if let (Value::Object(all), Value::Object(entries)) = (&mut all, entries) {
        all.extend(entries);
    }
    all
}

/// Words of ours as a key, or as one of a few values: `closed form` is `closedForm`.
pub fn key(words: &str) -> String {
    let mut key = String::new();
    for (i, word) in words.split([' ', '-']).enumerate() {
        let mut letters = word.chars();
        match letters.next() {
            Some(first) if i > 0 => key.extend(first.to_uppercase()),
            first => key.extend(first),
        }
        key.push_str(letters.as_str());
    }
    key
}

/// All findings and their counts. Without the file of a finding among `files`, its places are `null`.
pub fn json(findings: &[Finding], files: &[&SourceFile]) -> Value {
    let summary = Summary::of(findings);
    json!({
        "findings": findings.iter().map(|f| one(f, files)).collect::<Vec<_>>(),
        "summary": {"errors": summary.errors, "warnings": summary.warnings, "notes": summary.notes},
    })
}

fn one(finding: &Finding, files: &[&SourceFile]) -> Value {
    let mut value = json!({"code": finding.code, "severity": finding.severity.as_str()});
    set_place(&mut value, files, &finding.path, &finding.span);
    value["message"] = json!(finding.message);
    value["why"] = json!(finding.why);
    value["help"] = json!(finding.help);
    value["fix"] = finding.fix.as_ref().map_or(Value::Null, |fix| {
        let mut value = json!({"text": fix.text, "applicability": fix.applicability.as_str()});
        set_place(&mut value, files, &finding.path, &fix.span);
        value
    });
    value["related"] = finding
        .related
        .iter()
        .map(|related| {
            let mut value = json!({"message": related.label});
            set_place(&mut value, files, &related.path, &related.span);
            value
        })
        .collect();
    value
}

/// Writes a place into an object. This is the one form of places in all reports: the file; bytes of the file; lines and
/// columns from 1, columns in characters; and the range as editors count it. An end is the place behind the last
/// character. Of a file that is not among `files` everything but its path is `null`.
pub fn set_place(object: &mut Value, files: &[&SourceFile], path: &str, span: &Range<usize>) {
    let file = file_of(files, path);
    let bytes = file.map(|f| f.snap(span));
    let (start, end) = (bytes.as_ref().map(|b| b.start), bytes.as_ref().map(|b| b.end));
    let at = |offset: Option<usize>| file.zip(offset).map(|(f, offset)| f.position(offset));
    let editor = |offset: Option<usize>| {
        let place = file.zip(offset).map(|(f, offset)| f.editor_position(offset));
        place.map(|EditorPosition { line, character }| json!({"line": line, "character": character}))
    };
    let (from, to) = (at(start), at(end));
    let range = editor(start).zip(editor(end)).map(|(start, end)| json!({"start": start, "end": end}));
    object["file"] = json!(path);
    object["start"] = json!(start);
    object["end"] = json!(end);
    object["line"] = json!(from.map(|p| p.line));
    object["column"] = json!(from.map(|p| p.column));
    object["endLine"] = json!(to.map(|p| p.line));
    object["endColumn"] = json!(to.map(|p| p.column));
    object["range"] = json!(range);
}

/// The name of what JSON has no number for: `NaN`, `Infinity` or `-Infinity`; `None` for every other number.
pub fn nonfinite(x: f64) -> Option<&'static str> {
    match x {
        x if x.is_nan() => Some("NaN"),
        f64::INFINITY => Some("Infinity"),
        f64::NEG_INFINITY => Some("-Infinity"),
        _ => None,
    }
}

/// Writes a number into an object. What is no number for JSON is `null`, and the object's `nonfinite` says under the same
/// key what it was, so that a key holds values of one type and nothing is lost.
pub fn set_number(object: &mut Value, key: &str, x: f64) {
    object[key] = json!(x);
    if let Some(name) = nonfinite(x) {
        object["nonfinite"][key] = json!(name);
    }
}

/// The same for a list, in which an entry may also be missing: `nonfinite` holds pairs of index and name.
pub fn set_numbers(object: &mut Value, key: &str, list: &[Option<f64>]) {
    object[key] = json!(list);
    let named = |(i, x): (usize, &Option<f64>)| x.and_then(nonfinite).map(|name| json!([i, name]));
    let lost: Vec<Value> = list.iter().enumerate().filter_map(named).collect();
    if !lost.is_empty() {
        object["nonfinite"][key] = Value::Array(lost);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_become_keys() {
        for (words, expected) in
            [("lab", "lab"), ("closed form", "closedForm"), ("not claimed", "notClaimed"), ("", "")]
        {
            assert_eq!(key(words), expected);
        }
    }

    #[test]
    fn a_place_has_all_its_forms() {
        let file = SourceFile::new("a.md", "\u{feff}one\r\n\"𝄞ä\" x");
        let mut value = json!({});
        // From the clef to the end of `x`, and from inside of it.
        for span in [9..17, 10..17] {
            set_place(&mut value, &[&file], "a.md", &span);
            let expected = json!({
                "file": "a.md", "start": 9, "end": 17, "line": 2, "column": 2, "endLine": 2, "endColumn": 6,
                "range": {"start": {"line": 1, "character": 1}, "end": {"line": 1, "character": 6}},
            });
            assert_eq!(value, expected);
            assert_eq!(value.to_string(), expected.to_string());
        }
        set_place(&mut value, &[&file], "b.md", &(0..1));
        assert_eq!(
            (&value["file"], &value["start"], &value["range"]),
            (&json!("b.md"), &Value::Null, &Value::Null)
        );
    }

    #[test]
    fn numbers_that_json_does_not_have_are_named_beside_their_place() {
        let mut value = json!({});
        set_number(&mut value, "a", 1.5);
        set_numbers(&mut value, "b", &[Some(-0.0), None]);
        assert_eq!(value.to_string(), r#"{"a":1.5,"b":[-0.0,null]}"#);
        set_number(&mut value, "a", f64::NEG_INFINITY);
        set_numbers(&mut value, "b", &[Some(f64::NAN), None, Some(2.0), Some(f64::INFINITY)]);
        let expected = json!({
            "a": null, "b": [null, null, 2.0, null],
            "nonfinite": {"a": "-Infinity", "b": [[0, "NaN"], [3, "Infinity"]]},
        });
        assert_eq!(value, expected);
    }
}
