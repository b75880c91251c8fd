//! Models from MJCF, with all that is found in their texts.

use super::error::Error;
use super::model::Model;
use crate::mjcf;
use std::path::Path;

pub use crate::mjcf::{
    Attr, Element, FileProblem, Files, Finding, Folder, Kind, MAX_ALL_ATTRIBUTES, MAX_ATTRIBUTES, MAX_DEPTH,
    MAX_DOFS, MAX_ELEMENTS, MAX_FILE, MAX_GEOMS, MAX_MASS, MAX_TEXT, MjcfFileError, NoFiles, Patch, Refusal,
    SchemaRow, Severity, Status, Word, rules, schema_rows,
};

/// What came of a model's text.
#[derive(Clone, Debug)]
pub struct Examined {
    /// The model; `None` when there are errors.
    pub model: Option<Model>,
    /// Errors and warnings in the order of the texts.
    pub findings: Vec<Finding>,
}

/// Compiles a model, and tells what it may not be meant to be, besides what is wrong. `path` is where `files` has the text
/// itself, if it has it: what it names is looked for in that folder.
pub fn check_xml(xml: &str, files: &dyn Files, path: Option<&str>) -> Examined {
    let mjcf::Examined { model, findings } = mjcf::check_xml(xml, files, path);
    Examined { model: model.map(Model::new), findings }
}

/// The same with changes of the text, made before it is compiled; with what is wrong with each of them.
pub fn check_patched(
    xml: &str,
    files: &dyn Files,
    path: Option<&str>,
    patches: &[Patch],
) -> (Examined, Vec<Option<Refusal>>) {
    let (mjcf::Examined { model, findings }, refusals) = mjcf::check_patched(xml, files, path, patches);
    (Examined { model: model.map(Model::new), findings }, refusals)
}

/// The text of a model with changes, and with what it includes in its place: what another program can read. Meshes and other files
/// that it names are still named. `None` when it is not XML, or a change cannot be made.
pub fn to_xml(xml: &str, files: &dyn Files, path: Option<&str>, patches: &[Patch]) -> Option<String> {
    mjcf::to_xml(xml, files, path, patches)
}

/// Compiles a model from its text; the mistakes as they were found.
pub fn compile(xml: &str) -> Result<Model, Vec<Finding>> {
    mjcf::compile(xml).map(Model::new)
}

/// Compiles a model from its text and the files that it names: see [`check_xml`].
pub fn compile_with(xml: &str, files: &dyn Files, path: Option<&str>) -> Result<Model, Vec<Finding>> {
    mjcf::compile_with(xml, files, path).map(Model::new)
}

/// Compiles a model from a file: see [`Model::from_file`].
pub fn compile_file(path: &Path) -> Result<Model, Error> {
    Model::from_file(path)
}
