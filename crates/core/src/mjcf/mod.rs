//! The MJCF compiler: XML text to a [`Model`], with MuJoCo 3.14.0's names, defaults and conventions.
//!
//! The text of a model passes through `text` (limits, XML, a tree that is checked with the one `schema`), `expand` (copies),
//! `classes` and `names`. Its elements are then converted to specifications (`spec`), from which `layout` and `fill` compute the
//! arrays. [`passes`] defines the order. The code for a kind of element (reading, checks, filling) is in the folder of that name.
//!
//! A pass reports errors and continues, so that one run shows all of them. A pass that would only repeat an earlier finding in
//! other words does not run until that finding is corrected.
//!
//! The meaning of elements and attributes is that of MuJoCo's XML reference. A [`Finding`] contains the position in the
//! file.

mod actuator;
mod arrays;
mod asset;
mod body;
mod classes;
mod constraint;
mod context;
mod expand;
mod fill;
mod gather;
mod geom;
mod ids;
mod keyword_map;
mod layout;
mod lints;
mod names;
mod passes;
pub mod rules;
mod scene;
mod schema;
mod sensor;
mod settings;
mod spec;
mod tendon;
#[cfg(test)]
mod tests;
mod text;
mod unsimulated;

use std::io::Read;
use std::path::Path;

use crate::model::Model;
use crate::source::files::{Files, Folder, MAX_TEXT, NoFiles};
use crate::source::model_patch::{Patch, Refusal};
use text::diagnostic::Diagnostics;

pub use labspec_finding::{Finding, Severity};
pub use schema::{Attr, AttributeType, Element, Keyword, SchemaRow, Status, schema_root, schema_rows};
pub use text::diagnostic::MjcfFileError;

/// Limit for the nesting depth of elements.
pub const MAX_DEPTH: usize = 1000;
/// Limit for the number of elements.
pub const MAX_ELEMENTS: usize = 200_000;
/// Limit for the number of degrees of freedom.
pub const MAX_DOFS: usize = 12_000;
/// Limit for the number of entries of the mass matrix: enough for a chain of 1500 degrees of freedom, or for many trees.
pub const MAX_MASS: usize = 1_200_000;
/// Limit for the number of geoms.
pub const MAX_GEOMS: usize = 5000;
/// Limit for the number of attributes of an element.
pub const MAX_ATTRIBUTES: usize = 200;
/// Limit for the number of attributes of all elements.
pub const MAX_ALL_ATTRIBUTES: usize = 1_000_000;

/// Compiles a model from its text. The text cannot refer to files; use [`compile_with`] or [`compile_file`] for that.
///
/// # Errors
///
/// All errors that were found, in the order of the text.
pub(crate) fn compile(xml: &str) -> Result<Model, Vec<Finding>> {
    compile_with(xml, &NoFiles, None)
}

/// Compiles a model from its text and the files that it names. `files` provides these files. `path` is the path of the text
/// itself in `files`, if it has one: files that the text names are searched for in that folder.
///
/// # Errors
///
/// All errors that were found, in the order of the texts. [`check_xml`] returns warnings as well.
pub(crate) fn compile_with(xml: &str, files: &dyn Files, path: Option<&str>) -> Result<Model, Vec<Finding>> {
    let mut report = Diagnostics::new();
    let model = build_model(xml, files, path, (&[], &mut Vec::new()), &mut report).map(|(_, model)| model);
    let mut findings = report.finish();
    findings.retain(|d| d.severity == Severity::Error);
    model.ok_or(findings)
}

/// The result of reading the text of a model.
#[derive(Clone, Debug)]
pub(crate) struct ParsedModel {
    /// The model; `None` when there are errors.
    pub model: Option<Model>,
    /// Errors and warnings, in the order of the texts.
    pub findings: Vec<Finding>,
}

/// Like [`compile_with`], but also returns warnings, which report what the author may not have intended.
pub(crate) fn check_xml(xml: &str, files: &dyn Files, path: Option<&str>) -> ParsedModel {
    check_patched(xml, files, path, &[]).0
}

/// Like [`check_xml`], with patches that are applied to the text before it is compiled. For each patch, also returns why it was
/// refused, or `None`.
pub(crate) fn check_patched(
    xml: &str,
    files: &dyn Files,
    path: Option<&str>,
    patches: &[Patch],
) -> (ParsedModel, Vec<Option<Refusal>>) {
    let (mut report, mut refusals) = (Diagnostics::new(), Vec::new());
    let built = build_model(xml, files, path, (patches, &mut refusals), &mut report);
    if let Some((tree, model)) = &built {
        lints::check_model(tree, model, &mut report);
    }
    (ParsedModel { model: built.map(|(_, model)| model), findings: report.finish() }, refusals)
}

/// The text of a model with its patches applied and its includes expanded, so that another program can read it. `None` if the
/// text is not XML, or a patch cannot be applied.
pub(crate) fn to_xml(xml: &str, files: &dyn Files, path: Option<&str>, patches: &[Patch]) -> Option<String> {
    text::load::Loader::new(files, patches).written(xml, path, &mut Diagnostics::new())
}

/// Builds a model that can be simulated, and its tree.
fn build_model(
    xml: &str,
    files: &dyn Files,
    path: Option<&str>,
    patches: (&[Patch], &mut Vec<Option<Refusal>>),
    report: &mut Diagnostics,
) -> Option<(text::tree::ElementTree, Model)> {
    let (tree, model) = passes::build(xml, files, path, patches, report)?;
    unsimulated::report_unsimulated(&tree, &model, report);
    report.is_clean().then_some((tree, model))
}

/// Compiles a model that may contain elements that cannot be simulated yet.
#[cfg(test)]
pub(crate) fn compile_only(xml: &str, files: &dyn Files) -> Result<Model, Vec<Finding>> {
    let mut report = Diagnostics::new();
    match passes::build(xml, files, None, (&[], &mut Vec::new()), &mut report) {
        Some((_, model)) if report.is_clean() => Ok(model),
        _ => Err(report.finish()),
    }
}

/// Compiles a model from a file. The model can refer to files in the same folder and in its subfolders.
///
/// # Errors
///
/// The file cannot be read, is too large, is not UTF-8, or the model has errors.
pub(crate) fn compile_file(path: &Path) -> Result<Model, MjcfFileError> {
    let owned = || path.to_path_buf();
    let io = |error| MjcfFileError::Io { path: owned(), error };
    let mut bytes = Vec::new();
    // Reads one byte more than the limit, to detect a file that is too large whatever its metadata state.
    std::fs::File::open(path).map_err(io)?.take(MAX_TEXT as u64 + 1).read_to_end(&mut bytes).map_err(io)?;
    if bytes.len() > MAX_TEXT {
        return Err(MjcfFileError::TooLarge { path: owned() });
    }
    let text = String::from_utf8(bytes)
        .map_err(|e| MjcfFileError::NotUtf8 { path: owned(), offset: e.utf8_error().valid_up_to() })?;
    let folder = Folder::new(path.parent().unwrap_or(Path::new(""))).map_err(io)?;
    compile_with(&text, &folder, path.file_name().and_then(|name| name.to_str()))
        .map_err(|diagnostics| MjcfFileError::Model { path: owned(), diagnostics })
}
