//! In place of the MJCF compiler in a build without the feature `mjcf`: every text is refused by the same finding.

#[path = "mjcf/rules/mod.rs"]
pub mod rules;

use crate::model::Model;
use crate::source::files::Files;
use crate::source::model_patch::{Patch, Refusal};

pub use labspec_finding::{Finding, Severity};

/// The result of reading the text of a model.
#[derive(Clone, Debug)]
pub(crate) struct ParsedModel {
    /// Always `None`.
    pub model: Option<Model>,
    /// The refusal.
    pub findings: Vec<Finding>,
}

/// The finding about every text.
fn refusal(xml: &str) -> Finding {
    let start = xml.find('<').unwrap_or(0);
    Finding::error(
        rules::NOT_SUPPORTED,
        start..xml.len().min(start + 1),
        "this build of labspec does not contain the MJCF compiler",
    )
    .why("it is smaller without, and loads compiled models only")
    .help("compile the model with a full build, store its bytes, and load the bytes here")
}

/// Refuses the text.
pub(crate) fn compile(xml: &str) -> Result<Model, Vec<Finding>> {
    Err(vec![refusal(xml)])
}

/// Refuses the text.
pub(crate) fn compile_with(xml: &str, _: &dyn Files, _: Option<&str>) -> Result<Model, Vec<Finding>> {
    compile(xml)
}

/// Refuses the text.
pub(crate) fn check_xml(xml: &str, _: &dyn Files, _: Option<&str>) -> ParsedModel {
    ParsedModel { model: None, findings: vec![refusal(xml)] }
}

/// Refuses the text.
pub(crate) fn check_patched(
    xml: &str,
    files: &dyn Files,
    path: Option<&str>,
    patches: &[Patch],
) -> (ParsedModel, Vec<Option<Refusal>>) {
    (check_xml(xml, files, path), vec![None; patches.len()])
}

/// Always `None`.
pub(crate) fn to_xml(_: &str, _: &dyn Files, _: Option<&str>, _: &[Patch]) -> Option<String> {
    None
}
