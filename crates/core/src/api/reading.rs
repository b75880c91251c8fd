//! Compilation of MJCF texts to models, with the findings in these texts.

use super::error::Error;
use super::model::Model;
use crate::mjcf;
#[cfg(feature = "mjcf")]
use std::path::Path;

#[cfg(feature = "mjcf")]
pub use crate::mjcf::{
    Attr, AttributeType, Element, Keyword, MAX_ALL_ATTRIBUTES, MAX_ATTRIBUTES, MAX_DEPTH, MAX_DOFS,
    MAX_ELEMENTS, MAX_GEOMS, MAX_MASS, MjcfFileError, SchemaRow, Status, schema_root, schema_rows,
};
pub use crate::mjcf::{Finding, Severity, rules};
pub use crate::source::files::{FileProblem, Files, Folder, MAX_FILE, MAX_TEXT, NoFiles};
pub use crate::source::model_patch::{Patch, Refusal};

/// The result of reading the text of a model.
#[derive(Clone, Debug)]
pub struct CheckedModel {
    /// The model; `None` when there are errors.
    pub model: Option<Model>,
    /// Errors and warnings, in the order of the texts.
    pub findings: Vec<Finding>,
}

/// Compiles a model and returns its errors and its warnings. A warning reports what the author may not have intended. `path` is
/// the path of the text itself in `files`, if it has one: files that the text names are searched for in that folder.
pub fn check_xml(xml: &str, files: &dyn Files, path: Option<&str>) -> CheckedModel {
    let mjcf::ParsedModel { model, findings } = mjcf::check_xml(xml, files, path);
    CheckedModel { model: model.map(Model::new), findings }
}

/// Like [`check_xml`], with patches that are applied to the text before it is compiled. For each patch, also returns why it was
/// refused, or `None`.
pub fn check_patched(
    xml: &str,
    files: &dyn Files,
    path: Option<&str>,
    patches: &[Patch],
) -> (CheckedModel, Vec<Option<Refusal>>) {
    let (mjcf::ParsedModel { model, findings }, refusals) = mjcf::check_patched(xml, files, path, patches);
    (CheckedModel { model: model.map(Model::new), findings }, refusals)
}

/// The text of a model with its patches applied and its includes expanded, so that another program can read it. Meshes and other
/// files stay references. `None` if the text is not XML or a patch cannot be applied.
pub fn to_xml(xml: &str, files: &dyn Files, path: Option<&str>, patches: &[Patch]) -> Option<String> {
    mjcf::to_xml(xml, files, path, patches)
}

/// Compiles a model from its text. Errors are the findings, in the order in which they were found.
pub fn compile(xml: &str) -> Result<Model, Vec<Finding>> {
    mjcf::compile(xml).map(Model::new)
}

/// Compiles a model from its text and the files that it names. See [`check_xml`].
pub fn compile_with(xml: &str, files: &dyn Files, path: Option<&str>) -> Result<Model, Vec<Finding>> {
    mjcf::compile_with(xml, files, path).map(Model::new)
}

/// Compiles a model from a file. See [`Model::from_file`].
#[cfg(feature = "mjcf")]
pub fn compile_file(path: &Path) -> Result<Model, Error> {
    Model::from_file(path)
}
