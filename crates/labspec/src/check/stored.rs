//! Serialization of findings. A code is stored as a name and looked up in the table of rules.

use crate::finding::{ClaimId, Finding, Fix, Place, Severity};
use crate::rules;
use labspec_finding::Position;
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::ops::Range;
use std::sync::Arc;

/// The name of a rule: a static text, not borrowed from the file.
type Code = &'static str;

/// The fields of a finding.
#[derive(Serialize, Deserialize)]
#[serde(remote = "Finding")]
struct FindingFields {
    #[serde(deserialize_with = "read_code")]
    code: Code,
    severity: Severity,
    path: Arc<str>,
    span: Range<usize>,
    position: Option<Position>,
    message: String,
    why: Option<String>,
    help: Option<String>,
    fix: Option<Fix>,
    related: Vec<Place>,
    claim: Option<Box<ClaimId>>,
    link: Option<Box<str>>,
}

#[derive(Serialize, Deserialize)]
struct StoredFinding(#[serde(with = "FindingFields")] Finding);

fn read_code<'de, D: Deserializer<'de>>(from: D) -> Result<Code, D::Error> {
    let name = String::deserialize(from)?;
    rules::find(&name).map(|rule| rule.code).ok_or_else(|| D::Error::custom("there is no such rule"))
}

pub(super) fn serialize<S: Serializer>(findings: &[Finding], to: S) -> Result<S::Ok, S::Error> {
    to.collect_seq(findings.iter().cloned().map(StoredFinding))
}

pub(super) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<Finding>, D::Error> {
    Ok(Vec::<StoredFinding>::deserialize(from)?.into_iter().map(|stored| stored.0).collect())
}
