//! JSON reports for editors and pipelines: their common parts. The reference is `docs/reports.md`, and `docs/schema`
//! contains a JSON Schema of each report.

use super::nonfinite::nonfinite;
#[cfg(feature = "report")]
use super::schema_parts::PartOf;
use super::{Summary, file_of};
use crate::finding::Finding;
#[cfg(feature = "report")]
use crate::finding::{Applicability, Severity};
use crate::json::to_value;
use crate::source::{EditorPosition, SourceFile};
use serde::Serialize;
use serde_json::Value;
use std::ops::Range;

/// The version of the format of all reports. It is incremented when programs that read them must change.
pub const SCHEMA_VERSION: u32 = 1;

/// A report, which begins with the version and its name.
pub fn report(name: &str, entries: impl Serialize) -> Value {
    #[derive(Serialize)]
    #[serde(rename_all = "camelCase")]
    struct VersionedReport<'a, T> {
        schema_version: u32,
        report: &'a str,
        #[serde(flatten)]
        entries: T,
    }
    to_value(&VersionedReport { schema_version: SCHEMA_VERSION, report: name, entries })
}

/// Converts words to a key or an enumeration value: `closed form` becomes `closedForm`.
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

/// All findings and their counts. If the file of a finding is not among `files`, its positions are `null`.
pub fn json(findings: &[Finding], files: &[&SourceFile]) -> Value {
    #[derive(Serialize)]
    struct Findings<'a> {
        findings: Vec<FindingRow<'a>>,
        summary: Summary,
    }
    let rows = findings.iter().map(|f| FindingRow::new(f, files)).collect();
    to_value(&Findings { findings: rows, summary: Summary::count(findings) })
}

/// One thing that is wrong or doubtful.
#[derive(Serialize)]
#[cfg_attr(feature = "report", derive(schemars::JsonSchema))]
pub struct FindingRow<'a> {
    /// The rule's code; `labspec explain CODE` says more.
    code: &'a str,
    /// How bad it is.
    #[cfg_attr(feature = "report", schemars(extend("enum" = Severity::ALL.map(Severity::as_str))))]
    severity: &'a str,
    #[serde(flatten)]
    #[cfg_attr(feature = "report", schemars(with = "PartOf<PlaceFields<'static>>"))]
    place: PlaceFields<'a>,
    /// What is wrong.
    message: &'a str,
    /// Why it matters; null when the message says it all.
    why: Option<&'a str>,
    /// What to write instead.
    help: Option<&'a str>,
    /// How to repair it; null when only its author can.
    fix: Option<FixRow<'a>>,
    /// Other places that help to understand it.
    related: Vec<RelatedRow<'a>>,
}

/// A replacement that a program may apply.
#[derive(Serialize)]
#[cfg_attr(feature = "report", derive(schemars::JsonSchema))]
struct FixRow<'a> {
    /// What to write at this place.
    text: &'a str,
    /// Who may do it: `safe`, any program; `unsafe`, a program that is asked to, because it is a guess; `display`, only the author.
    #[cfg_attr(feature = "report", schemars(extend("enum" = Applicability::ALL.map(Applicability::as_str))))]
    applicability: &'a str,
    #[serde(flatten)]
    #[cfg_attr(feature = "report", schemars(with = "PartOf<PlaceFields<'static>>"))]
    place: PlaceFields<'a>,
}

/// Another place.
#[derive(Serialize)]
#[cfg_attr(feature = "report", derive(schemars::JsonSchema))]
struct RelatedRow<'a> {
    /// What is there.
    message: &'a str,
    #[serde(flatten)]
    #[cfg_attr(feature = "report", schemars(with = "PartOf<PlaceFields<'static>>"))]
    place: PlaceFields<'a>,
}

impl<'a> FindingRow<'a> {
    /// The row of a finding. If its file is not among `files`, its positions are `null`.
    pub fn new(f: &'a Finding, files: &[&SourceFile]) -> FindingRow<'a> {
        FindingRow {
            code: f.code,
            severity: f.severity.as_str(),
            place: PlaceFields::new(files, &f.path, &f.span),
            message: &f.message,
            why: f.why.as_deref(),
            help: f.help.as_deref(),
            fix: f.fix.as_ref().map(|fix| FixRow {
                text: &fix.text,
                applicability: fix.applicability.as_str(),
                place: PlaceFields::new(files, &f.path, &fix.span),
            }),
            related: (f.related.iter())
                .map(|r| RelatedRow { message: &r.label, place: PlaceFields::new(files, &r.path, &r.span) })
                .collect(),
        }
    }
}

/// A place in a file. Of a file that could not be read everything but its path is null.
///
/// All reports have places in this form.
#[derive(Default, Serialize)]
#[serde(rename_all = "camelCase")]
#[cfg_attr(feature = "report", derive(schemars::JsonSchema), schemars(rename = "place"))]
pub struct PlaceFields<'a> {
    /// The file, as it was named on the command line or found from there.
    file: &'a str,
    /// Bytes of the file before the place.
    start: Option<usize>,
    /// Bytes of the file up to the end of the place.
    end: Option<usize>,
    /// Line of the start, from 1.
    #[cfg_attr(feature = "report", schemars(range(min = 1)))]
    line: Option<usize>,
    /// Column of the start in characters, from 1.
    #[cfg_attr(feature = "report", schemars(range(min = 1)))]
    column: Option<usize>,
    /// Line of the end, from 1.
    #[cfg_attr(feature = "report", schemars(range(min = 1)))]
    end_line: Option<usize>,
    /// Column behind the last character, from 1.
    #[cfg_attr(feature = "report", schemars(range(min = 1)))]
    end_column: Option<usize>,
    /// The same location as a `Range` of the Language Server Protocol: lines from 0, characters in UTF-16 code units.
    range: Option<EditorRange>,
}

/// From the first character to the place behind the last.
#[derive(Serialize)]
#[cfg_attr(feature = "report", derive(schemars::JsonSchema))]
struct EditorRange {
    /// The first character.
    start: EditorPlace,
    /// The place behind the last character.
    end: EditorPlace,
}

/// A `Position` of the Language Server Protocol.
#[derive(Serialize)]
#[cfg_attr(feature = "report", derive(schemars::JsonSchema), schemars(rename = "position"))]
struct EditorPlace {
    /// Line, from 0.
    line: usize,
    /// Units of UTF-16 before it on its line, from 0.
    character: usize,
}

impl<'a> PlaceFields<'a> {
    /// The location of a range of bytes of a file.
    pub fn new(files: &[&SourceFile], path: &'a str, span: &Range<usize>) -> PlaceFields<'a> {
        let Some(file) = file_of(files, path) else {
            return PlaceFields { file: path, ..PlaceFields::default() };
        };
        let bytes = file.snap(span);
        let [from, to] = [bytes.start, bytes.end].map(|offset| file.position(offset));
        let [start, end] = [bytes.start, bytes.end].map(|offset| {
            let EditorPosition { line, character } = file.editor_position(offset);
            EditorPlace { line, character }
        });
        PlaceFields {
            file: path,
            start: Some(bytes.start),
            end: Some(bytes.end),
            line: Some(from.line),
            column: Some(from.column),
            end_line: Some(to.line),
            end_column: Some(to.column),
            range: Some(EditorRange { start, end }),
        }
    }
}

/// Writes a number into an object. A number that JSON cannot represent is `null`, and `nonfinite` contains its name under
/// the same key. So every key has values of one type and no information is lost.
pub fn set_number(object: &mut Value, key: &str, x: f64) {
    object[key] = x.into();
    if let Some(name) = nonfinite(x) {
        object["nonfinite"][key] = name.into();
    }
}

/// Writes a list of numbers into an object, like [`set_number`]. Entries may be missing; `nonfinite` contains pairs of
/// index and name.
pub fn set_numbers(object: &mut Value, key: &str, list: &[Option<f64>]) {
    object[key] = list.into();
    let named = |(i, x): (usize, &Option<f64>)| Some((i, nonfinite((*x)?)?));
    let lost: Vec<_> = list.iter().enumerate().filter_map(named).collect();
    if !lost.is_empty() {
        object["nonfinite"][key] = to_value(&lost);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

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
        // From the clef to the end of `x`, and from inside the clef.
        for span in [9..17, 10..17] {
            let value = to_value(&PlaceFields::new(&[&file], "a.md", &span));
            let expected = json!({
                "file": "a.md", "start": 9, "end": 17, "line": 2, "column": 2, "endLine": 2, "endColumn": 6,
                "range": {"start": {"line": 1, "character": 1}, "end": {"line": 1, "character": 6}},
            });
            assert_eq!(value, expected);
            assert_eq!(value.to_string(), expected.to_string());
        }
        let value = to_value(&PlaceFields::new(&[&file], "b.md", &(0..1)));
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
