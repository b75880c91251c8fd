//! Findings as SARIF 2.1.0, the format of code scanners: the objects of the standard that are needed, with its names.

use super::formats::{fingerprint, place_of};
use super::to_value;
use super::uri::uri;
use crate::finding::{Applicability, Finding};
use crate::rules;
use crate::source::SourceFile;
use serde::Serialize;
use serde_json::Value;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::ops::Range;

/// The address of the pages of the rules.
const PAGES: &str = "https://github.com/labspec/labspec/blob/main/docs/reference/rules";

/// The page of a rule.
pub fn page(code: &str) -> String {
    format!("{PAGES}/{code}.md")
}

#[derive(Serialize)]
struct Log<'a> {
    #[serde(rename = "$schema")]
    schema: &'a str,
    version: &'a str,
    runs: [SarifRun<'a>; 1],
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct SarifRun<'a> {
    tool: Tool<'a>,
    column_kind: &'a str,
    results: Vec<SarifResult<'a>>,
}

#[derive(Serialize)]
struct Tool<'a> {
    driver: Driver<'a>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Driver<'a> {
    name: &'a str,
    version: &'a str,
    information_uri: &'a str,
    rules: Vec<Descriptor<'a>>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Descriptor<'a> {
    id: &'a str,
    help_uri: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    short_description: Option<Message<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    default_configuration: Option<Configuration<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    full_description: Option<Message<'a>>,
}

#[derive(Serialize)]
struct Configuration<'a> {
    level: &'a str,
}

#[derive(Serialize)]
struct Message<'a> {
    text: Cow<'a, str>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct SarifResult<'a> {
    rule_id: &'a str,
    rule_index: usize,
    level: &'a str,
    message: Message<'a>,
    locations: [Location; 1],
    partial_fingerprints: BTreeMap<&'a str, String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    fixes: Option<[SarifFix<'a>; 1]>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Location {
    physical_location: PhysicalLocation,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct PhysicalLocation {
    artifact_location: ArtifactLocation,
    /// `None` for a file that could not be read.
    #[serde(skip_serializing_if = "Option::is_none")]
    region: Option<Region>,
}

#[derive(Serialize)]
struct ArtifactLocation {
    uri: String,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Region {
    start_line: usize,
    start_column: usize,
    end_line: usize,
    end_column: usize,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct SarifFix<'a> {
    description: Message<'a>,
    artifact_changes: [ArtifactChange<'a>; 1],
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct ArtifactChange<'a> {
    artifact_location: ArtifactLocation,
    replacements: [Replacement<'a>; 1],
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Replacement<'a> {
    deleted_region: Region,
    inserted_content: Message<'a>,
}

impl<'a, T: Into<Cow<'a, str>>> From<T> for Message<'a> {
    fn from(text: T) -> Message<'a> {
        Message { text: text.into() }
    }
}

/// The log of one run.
pub fn sarif(findings: &[Finding], files: &[&SourceFile]) -> Value {
    let mut codes: Vec<&str> = findings.iter().map(|f| f.code).collect();
    codes.sort_unstable();
    codes.dedup();
    let mut seen = BTreeMap::new();
    let results = findings.iter().map(|f| SarifResult {
        rule_id: f.code,
        rule_index: codes.binary_search(&f.code).unwrap_or(0),
        level: f.severity.as_str(),
        message: [Some(&f.message), f.why.as_ref(), f.help.as_ref()]
            .into_iter()
            .flatten()
            .map(String::as_str)
            .collect::<Vec<_>>()
            .join(". ")
            .into(),
        locations: [Location {
            physical_location: PhysicalLocation {
                artifact_location: artifact(f),
                region: region(f, &f.span, files),
            },
        }],
        partial_fingerprints: BTreeMap::from([("labspec/v1", fingerprint(f, &mut seen))]),
        fixes: fix(f, files).map(|fix| [fix]),
    });
    let results = results.collect();
    to_value(&Log {
        schema: "https://json.schemastore.org/sarif-2.1.0.json",
        version: "2.1.0",
        runs: [SarifRun {
            tool: Tool {
                driver: Driver {
                    name: "labspec",
                    version: env!("CARGO_PKG_VERSION"),
                    information_uri: env!("CARGO_PKG_REPOSITORY"),
                    rules: codes.into_iter().map(descriptor).collect(),
                },
            },
            column_kind: "unicodeCodePoints",
            results,
        }],
    })
}

fn descriptor(code: &str) -> Descriptor<'_> {
    let rule = rules::find(code);
    Descriptor {
        id: code,
        help_uri: page(code),
        short_description: rule.map(|r| r.summary.into()),
        default_configuration: rule.map(|r| Configuration { level: r.severity.as_str() }),
        full_description: rule.filter(|r| !r.why.is_empty()).map(|r| r.why.into()),
    }
}

fn artifact(f: &Finding) -> ArtifactLocation {
    ArtifactLocation { uri: uri(&f.path) }
}

fn region(f: &Finding, span: &Range<usize>, files: &[&SourceFile]) -> Option<Region> {
    let [start_line, start_column, end_line, end_column] = place_of(&f.path, span, files)?;
    Some(Region { start_line, start_column, end_line, end_column })
}

/// The fix of a finding, if a program may apply it.
fn fix<'a>(f: &'a Finding, files: &[&SourceFile]) -> Option<SarifFix<'a>> {
    let fix = f.fix.as_ref().filter(|fix| fix.applicability != Applicability::Display)?;
    let replacement = Replacement {
        deleted_region: region(f, &fix.span, files)?,
        inserted_content: fix.text.as_str().into(),
    };
    Some(SarifFix {
        description: f.help.as_ref().unwrap_or(&f.message).into(),
        artifact_changes: [ArtifactChange { artifact_location: artifact(f), replacements: [replacement] }],
    })
}
