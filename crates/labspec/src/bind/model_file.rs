//! Compiles a model file: the model, its findings, and the files of the findings.

use super::parts::{Hash, ModelFile, RecordingFiles};
use crate::finding::{Finding, InFile};
use crate::lint::{ModelFolder, lesson_folder, root_of};
use crate::models::FilesOf;
use crate::rules;
use crate::source::{SourceFile, Sources, Text};
use crate::spec::{Lab, ModelSource};
use labspec_core::Model;
use labspec_core::xml::{self, CheckedModel, FileProblem, Files, Folder, NoFiles};
use labspec_finding::nearest;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The result of compiling a model file.
#[derive(Debug, Default)]
pub struct Compiled {
    /// `None` when there are errors.
    pub model: Option<Model>,
    /// Errors and warnings.
    pub findings: Vec<Finding>,
    /// The files of the findings; empty when there are no findings.
    pub files: Vec<SourceFile>,
    /// The other files that were read, and those of textures, which only views read.
    pub parts: Vec<ModelFile>,
}

/// Compiles the model of a file. The files that it names (included text, models to attach, meshes) are resolved from the
/// folder of `path`, and opened if they are below `root`.
pub fn compile_file(
    file: &SourceFile,
    path: &Path,
    root: &Path,
    sources: &Sources,
    hash: Option<Hash>,
) -> Compiled {
    let files = FilesAround::below(path, root, sources);
    compile_source(file, &files, path.file_name().and_then(|n| n.to_str()), hash, xml::check_xml)
}

/// The help for bytes that are not a model of this engine.
const STORE_AGAIN: &str = "compile the model with the same version of labspec that loads it";

/// Compiles the model of a lab for playing: with errors, but without warnings.
pub(crate) fn compile_to_play(lab: &Lab, folder: &ModelFolder) -> Compiled {
    let refused = |rule, field: &Text, message: String, help: String| Compiled {
        findings: vec![Finding::error(rule, field.span(), message).help(help)],
        ..Compiled::default()
    };
    let name = match lab.scene() {
        None => return Compiled::default(),
        Some(ModelSource::Xml(text)) => {
            let checked = compile_errors(&text.value, &NoFiles, None);
            let place = |d: &Finding| from_mjcf(d, text.span_of(d.span.clone()));
            let findings = checked.findings.iter().map(place).collect();
            return Compiled { model: checked.model, findings, ..Compiled::default() };
        }
        Some(ModelSource::Model(name)) => name,
    };
    if let Some(bytes) = folder.given().and_then(|given| given.compiled(&name.value)) {
        return match Model::from_bytes(&bytes) {
            Ok(model) => Compiled { model: Some(model), ..Compiled::default() },
            Err(e) => refused(
                rules::MODEL_UNREADABLE,
                name,
                format!("the model `{}` cannot be loaded: {e}", name.value),
                STORE_AGAIN.into(),
            ),
        };
    }
    if let Some(given) = folder.given()
        && let Some(text) = given.text(&name.value)
    {
        let file = SourceFile::new(format!("models/{}.xml", name.value), text);
        let own_name = format!("{}.xml", name.value);
        return compile_source(&file, &FilesOf(given), Some(&own_name), None, compile_errors);
    }
    let Some(path) = folder.path(&name.value) else {
        let existing = folder.names().unwrap_or_default();
        let close = nearest(&name.value, existing.iter().map(String::as_str));
        let help = close.map_or("pass it with the models".into(), |close| format!("write `{close}`"));
        return refused(rules::UNKNOWN_MODEL, name, format!("there is no model `{}`", name.value), help);
    };
    match read_file(&path, &Sources::Disk) {
        Err(message) => refused(rules::MODEL_UNREADABLE, name, message, "check the file".into()),
        Ok(file) => {
            let files = FilesAround::below(&path, folder.root(), &Sources::Disk);
            let own_name = path.file_name().and_then(|n| n.to_str());
            compile_source(&file, &files, own_name, None, compile_errors)
        }
    }
}

/// Compiles a model with its errors, without the warnings of [`xml::check_xml`].
fn compile_errors(xml: &str, files: &dyn Files, path: Option<&str>) -> CheckedModel {
    match xml::compile_with(xml, files, path) {
        Ok(model) => CheckedModel { model: Some(model), findings: Vec::new() },
        Err(findings) => CheckedModel { model: None, findings },
    }
}

/// A model file: the text in the editor, or else the saved file.
pub(super) fn read_file(path: &Path, sources: &Sources) -> Result<SourceFile, String> {
    match sources.text_in_memory(path) {
        Some((_, text)) => Ok(SourceFile::new(path.display().to_string(), text)),
        None => SourceFile::read(path),
    }
}

/// The files around a model: texts in the editor, or else saved files.
pub(super) struct FilesAround<'s> {
    /// `None` where the model is outside of the root.
    folder: Option<Folder>,
    place: PathBuf,
    root: &'s Path,
    sources: &'s Sources,
}

impl<'s> FilesAround<'s> {
    pub(super) fn below(model: &Path, root: &'s Path, sources: &'s Sources) -> FilesAround<'s> {
        let place = model.parent().unwrap_or(Path::new("")).to_path_buf();
        FilesAround { folder: Folder::at(root, &place).ok(), place, root, sources }
    }
}

impl Files for FilesAround<'_> {
    fn read(&self, path: &str, limit: usize) -> Result<Vec<u8>, FileProblem> {
        let Some(folder) = &self.folder else { return NoFiles.read(path, limit) };
        match self.sources.text_in_memory(&self.place.join(path)) {
            Some((real, _)) if !real.starts_with(self.root) => Err(FileProblem::Outside),
            Some((_, text)) if text.len() > limit => Err(FileProblem::TooLarge),
            Some((_, text)) => Ok(text.into_bytes()),
            None => folder.read(path, limit),
        }
    }
}

/// Compiles the text of a model, whose name among `files` is `name`.
pub(super) fn compile_source(
    file: &SourceFile,
    files: &dyn Files,
    name: Option<&str>,
    hash: Option<Hash>,
    compile: fn(&str, &dyn Files, Option<&str>) -> CheckedModel,
) -> Compiled {
    let remembering = RecordingFiles::new(files, hash);
    let checked = compile(file.text(), &remembering, name);
    remembering.record_textures(checked.model.as_ref());
    let mut sources = Vec::new();
    if !checked.findings.is_empty() {
        sources.push(file.clone());
    }
    let place_of = |d: &Finding| {
        let index = if d.path.is_empty() { 0 } else { part_of(&mut sources, files, &d.path) };
        let finding = from_mjcf(d, d.span.clone());
        sources.get(index).map_or(finding.clone(), |source| finding.at(source))
    };
    let findings = checked.findings.iter().map(place_of).collect();
    Compiled { model: checked.model, findings, files: sources, parts: remembering.parts() }
}

/// Compiles a model file alone: the model, its findings, and the files of the findings. A file that cannot be read is a
/// finding too. `root` is the folder below which files may be read; the default is the nearest folder above that is marked
/// as a root.
pub fn check_model_file(
    path: &Path,
    root: Option<&Path>,
) -> (Option<Arc<Model>>, Vec<Finding>, Vec<SourceFile>) {
    let file = match SourceFile::read(path) {
        Ok(file) => file,
        Err(message) => {
            let file = SourceFile::new(path.display().to_string(), "");
            return (
                None,
                vec![Finding::error(rules::MODEL_UNREADABLE, 0..0, message).at(&file)],
                vec![file],
            );
        }
    };
    let root = root.map_or_else(|| root_of(&lesson_folder(path), &[]), Path::to_path_buf);
    let sources = Sources::Disk;
    let Compiled { model, findings, mut files, .. } = compile_file(&file, path, &root, &sources, None);
    if files.is_empty() {
        files.push(file);
    }
    (model.map(Arc::new), findings, files)
}

/// The index of a file that a model names, which is added to the list on first use. A file that is not text (a mesh) is
/// listed with an empty text.
fn part_of(sources: &mut Vec<SourceFile>, files: &dyn Files, part: &str) -> usize {
    let displayed = match sources.first().and_then(|main| main.path().rsplit_once('/')) {
        Some((folder, _)) => joined(folder, part),
        None => part.to_string(),
    };
    if let Some(index) = sources.iter().position(|f| **f.path() == *displayed) {
        return index;
    }
    let read = files.read(part, xml::MAX_TEXT).ok().and_then(|bytes| String::from_utf8(bytes).ok());
    sources.push(SourceFile::new(displayed, read.unwrap_or_default()));
    sources.len() - 1
}

/// A path relative to a folder, with `..` resolved.
fn joined(folder: &str, path: &str) -> String {
    let (mut folder, mut path) = (folder, path);
    while let Some(rest) = path.strip_prefix("../") {
        match folder.rsplit_once('/') {
            _ if folder.is_empty() || folder == "." || folder.ends_with("..") => break,
            Some((above, _)) => folder = above,
            None => folder = "",
        }
        path = rest;
    }
    if folder.is_empty() { path.to_string() } else { format!("{folder}/{path}") }
}

/// The help for widening the root.
const WIDER_ROOT_HELP: &str =
    "put an empty file `labspec.toml` into the folder that holds both, or name that folder with --root";

/// A finding of a model with a span in the file that contains it.
pub fn from_mjcf(d: &Finding, span: Range<usize>) -> Finding {
    // The engine does not know the options of the program, so this help is added here.
    let outside = d.code == xml::rules::OUTSIDE.code;
    let help = if outside { Some(WIDER_ROOT_HELP.to_string()) } else { d.help.clone() };
    Finding { span, path: Arc::from(""), position: None, help, ..d.clone() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shown_paths_are_short() {
        for (folder, path, expected) in [
            ("models", "a.xml", "models/a.xml"),
            ("models", "../stls/a.stl", "stls/a.stl"),
            ("a/b", "../../c/d", "c/d"),
            ("a", "../../c/d", "../c/d"),
            ("../a", "../c", "../c"),
            ("..", "../c", "../../c"),
        ] {
            assert_eq!(joined(folder, path), expected, "{folder} {path}");
        }
    }
}
