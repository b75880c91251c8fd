//! The model of a lab: from the model folder or from the lab itself, with every mistake at its place.

use crate::finding::{Finding, InFile};
use crate::lint::{ModelFolder, lesson_folder, root_of};
use crate::models::FilesOf;
use crate::rules;
use crate::source::{SourceFile, Text};
use crate::spec::{Lab, Scene};
use labspec_core::Model;
use labspec_core::xml::{self, Files, Folder, NoFiles};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

/// Models by name, compiled once, and the files they came from.
#[derive(Debug, Default)]
pub struct Models {
    folder: ModelFolder,
    compiled: BTreeMap<String, Option<Arc<Model>>>,
    files: Vec<SourceFile>,
    /// Findings in the model files themselves.
    findings: Vec<Finding>,
}

impl Models {
    /// The models of a folder. Nothing is read yet.
    pub fn new(folder: ModelFolder) -> Models {
        Models { folder, ..Models::default() }
    }

    /// The folder.
    pub fn folder(&self) -> &ModelFolder {
        &self.folder
    }

    /// The files of the models that had something to say.
    pub fn files(&self) -> &[SourceFile] {
        &self.files
    }

    /// Takes what was found in model files since the last call.
    pub fn take_findings(&mut self) -> Vec<Finding> {
        std::mem::take(&mut self.findings)
    }

    /// The model of a lab. `None` when there is none or it has mistakes; those in an inline model are added to
    /// `findings`, those in a model file to the findings of the models, once.
    pub fn of(&mut self, lab: &Lab, findings: &mut Vec<Finding>) -> Option<Arc<Model>> {
        match lab.scene()? {
            Scene::Xml(text) => {
                let examined = xml::examine(&text.value, &NoFiles, None);
                findings.extend(examined.findings.iter().map(|d| inline(d, text)));
                examined.model.map(Arc::new)
            }
            Scene::Model(name) => {
                let known = self.compiled.get(&name.value).cloned();
                let model = known.unwrap_or_else(|| self.load(&name.value));
                // A model that does not exist is reported by the rules of the lesson's structure.
                if model.is_none() && self.folder.has(&name.value) {
                    findings.push(
                        Finding::error(rules::MODEL_BROKEN, name.span(), format!("the model `{}` has mistakes", name.value))
                            .why("this lab cannot run, and its expressions cannot be checked, until the model loads")
                            .help(format!("correct what is reported for {}.xml", name.value)),
                    );
                }
                model
            }
        }
    }

    fn load(&mut self, name: &str) -> Option<Arc<Model>> {
        if let Some(models) = self.folder.given() {
            let file = SourceFile::new(format!("models/{name}.xml"), models.text(name)?);
            let compiled = compile_source(&file, &FilesOf(models), Some(&format!("{name}.xml")));
            return self.keep(name, compiled);
        }
        let path = self.folder.path(name)?;
        // The folder and the file: enough to find it, and the same on every machine.
        let folder = path.parent().and_then(|p| p.file_name()).and_then(|f| f.to_str()).unwrap_or("models");
        let shown = format!("{folder}/{name}.xml");
        let compiled = match SourceFile::read(&path) {
            Ok(file) => compile_file(&SourceFile::new(shown, file.text()), &path, self.folder.root()),
            Err(message) => {
                let file = SourceFile::new(shown, "");
                let finding = Finding::error(rules::MODEL_UNREADABLE, 0..0, message).at(&file);
                Compiled { model: None, findings: vec![finding], files: vec![file] }
            }
        };
        self.keep(name, compiled)
    }

    /// Remembers what came of a model.
    fn keep(&mut self, name: &str, compiled: Compiled) -> Option<Arc<Model>> {
        self.findings.extend(compiled.findings);
        self.files.extend(compiled.files);
        let model = compiled.model.map(Arc::new);
        self.compiled.insert(name.to_string(), model.clone());
        model
    }
}

/// What came of a model file: the model, what is wrong with it or doubtful, and the files that this is about.
#[derive(Debug)]
pub(crate) struct Compiled {
    /// `None` when there are errors.
    pub(crate) model: Option<Model>,
    pub(crate) findings: Vec<Finding>,
    /// Empty when there are no findings.
    pub(crate) files: Vec<SourceFile>,
}

/// Compiles the model of a file. What it names (included text, models to attach, meshes) is looked for from the folder of
/// `path`, and opened when it lies below `root`.
pub(crate) fn compile_file(file: &SourceFile, path: &Path, root: &Path) -> Compiled {
    let place = path.parent().unwrap_or(Path::new(""));
    let folder = Folder::at(root, place).ok();
    let files: &dyn Files = folder.as_ref().map_or(&NoFiles, |folder| folder);
    compile_source(file, files, path.file_name().and_then(|n| n.to_str()))
}

/// Compiles the text of a model, which `files` has as `name`.
fn compile_source(file: &SourceFile, files: &dyn Files, name: Option<&str>) -> Compiled {
    let examined = xml::examine(file.text(), files, name);
    let mut sources = Vec::new();
    if !examined.findings.is_empty() {
        sources.push(file.clone());
    }
    let place_of = |d: &Finding| {
        let at = if d.path.is_empty() { 0 } else { part_of(&mut sources, files, &d.path) };
        let finding = from_mjcf(d, d.span.clone());
        sources.get(at).map_or(finding.clone(), |source| finding.at(source))
    };
    let findings = examined.findings.iter().map(place_of).collect();
    Compiled { model: examined.model, findings, files: sources }
}

/// Compiles a model file, for itself: the model, what is to be said of it, and the files that this is about. A file that
/// cannot be read is a finding, too. `root` is what it may read; by default the nearest folder around it that is marked as one.
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
    let Compiled { model, findings, mut files } = compile_file(&file, path, &root);
    if files.is_empty() {
        files.push(file);
    }
    (model.map(Arc::new), findings, files)
}

/// The index of a file that a model names in the list, to which it is added the first time. A file that is no text
/// (a mesh) is shown empty.
fn part_of(sources: &mut Vec<SourceFile>, files: &dyn Files, part: &str) -> usize {
    let shown = match sources.first().and_then(|main| main.path().rsplit_once('/')) {
        Some((folder, _)) => joined(folder, part),
        None => part.to_string(),
    };
    if let Some(known) = sources.iter().position(|f| **f.path() == *shown) {
        return known;
    }
    let read = files.read(part, xml::MAX_TEXT).ok().and_then(|bytes| String::from_utf8(bytes).ok());
    sources.push(SourceFile::new(shown, read.unwrap_or_default()));
    sources.len() - 1
}

/// A path from a folder, without the steps that only lead back.
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

/// How to open more.
const WIDEN: &str =
    "put an empty file `labspec.toml` into the folder that holds both, or name that folder with --root";

fn inline(d: &Finding, text: &Text) -> Finding {
    from_mjcf(d, text.span_of(d.span.clone()))
}

/// A mistake in a model, at a place of the file that holds it.
pub fn from_mjcf(d: &Finding, span: std::ops::Range<usize>) -> Finding {
    // The engine knows no program: how to widen the root is said here.
    let outside = d.code == xml::rules::OUTSIDE.code;
    let help = if outside { Some(WIDEN.to_string()) } else { d.help.clone() };
    Finding { span, path: Arc::from(""), position: None, help, ..d.clone() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::finding::Severity;

    const TETRAHEDRON: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

    fn model(mesh: &str) -> String {
        format!(
            "<mujoco><asset><mesh name='m' file='{mesh}'/></asset>\n<worldbody>> <geom type='mesh' mesh='m'/></worldbody></mujoco>"
        )
    }

    /// A mesh in a sister folder is opened when the root holds both; what lies outside is refused with the way to widen it.
    #[test]
    fn a_model_reads_what_lies_below_the_root() {
        let top = tempfile::tempdir().unwrap();
        for folder in ["robot/models", "robot/meshes"] {
            std::fs::create_dir_all(top.path().join(folder)).unwrap();
        }
        std::fs::write(top.path().join("robot/meshes/a.obj"), TETRAHEDRON).unwrap();
        let path = top.path().join("robot/models/arm.xml");
        std::fs::write(&path, model("../meshes/a.obj")).unwrap();

        let (none, findings, files) = check_model_file(&path, None);
        assert!(none.is_none());
        let outside = findings.iter().find(|f| f.code == "mjcf-file-outside").unwrap();
        assert_eq!(outside.severity, Severity::Error);
        assert!(outside.help.as_ref().unwrap().contains("labspec.toml"), "{outside:?}");
        assert_eq!(files.len(), 1);

        let (some, _, _) = check_model_file(&path, Some(&top.path().join("robot")));
        assert!(some.is_some());
        std::fs::write(top.path().join("robot/labspec.toml"), "").unwrap();
        let (some, findings, files) = check_model_file(&path, None);
        assert_eq!(some.unwrap().nmesh, 1);
        // What is doubtful is said, and stops nothing.
        let [warning] = findings.as_slice() else { panic!("{findings:?}") };
        assert_eq!((warning.code, warning.severity), ("mjcf-text", Severity::Warning));
        assert_eq!(files[0].slice(warning.span.clone()), ">");
    }

    /// The warnings of a lab's model are findings of the model's file, once, and the lab has its model.
    #[test]
    fn warnings_of_a_model_do_not_stop_its_lab() {
        let top = tempfile::tempdir().unwrap();
        let folder = top.path().join("models");
        std::fs::create_dir(&folder).unwrap();
        std::fs::write(folder.join("odd.xml"), "<mujoco>x<worldbody><geom size='1'/></worldbody></mujoco>")
            .unwrap();
        let mut models = Models::new(ModelFolder::open(&folder).unwrap());
        assert!(models.load("odd").is_some());
        let findings = models.take_findings();
        assert_eq!(findings.len(), 1);
        assert_eq!((findings[0].code, &*findings[0].path), ("mjcf-text", "models/odd.xml"));
        assert!(models.take_findings().is_empty());
        assert_eq!(models.files().len(), 1);
    }

    #[test]
    fn shown_paths_are_short() {
        for (folder, path, shown) in [
            ("models", "a.xml", "models/a.xml"),
            ("models", "../stls/a.stl", "stls/a.stl"),
            ("a/b", "../../c/d", "c/d"),
            ("a", "../../c/d", "../c/d"),
            ("../a", "../c", "../c"),
            ("..", "../c", "../../c"),
        ] {
            assert_eq!(joined(folder, path), shown, "{folder} {path}");
        }
    }
}
