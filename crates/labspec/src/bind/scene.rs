//! The model of a lab: from the model folder or from the lab itself, with every mistake at its place.

use crate::finding::{Finding, Severity};
use crate::lint::ModelFolder;
use crate::source::{SourceFile, Text};
use crate::spec::{Lab, Scene};
use labspec_core::Model;
use labspec_core::mjcf::{self, Folder, MjcfDiagnostic};
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
            Scene::Xml(text) => match mjcf::compile(&text.value) {
                Ok(model) => Some(Arc::new(model)),
                Err(list) => {
                    findings.extend(list.iter().map(|d| inline(d, text)));
                    None
                }
            },
            Scene::Model(name) => {
                let known = self.compiled.get(&name.value).cloned();
                let model = known.unwrap_or_else(|| self.load(&name.value));
                // A model that does not exist is reported by the rules of the lesson's structure.
                if model.is_none() && self.folder.path(&name.value).is_some() {
                    findings.push(
                        finding("model-broken", name.span(), format!("the model `{}` has mistakes", name.value))
                            .why("this lab cannot run, and its expressions cannot be checked, until the model loads")
                            .help(format!("correct what is reported for {}.xml", name.value)),
                    );
                }
                model
            }
        }
    }

    fn load(&mut self, name: &str) -> Option<Arc<Model>> {
        let path = self.folder.path(name)?;
        // The folder and the file: enough to find it, and the same on every machine.
        let folder = path.parent().and_then(|p| p.file_name()).and_then(|f| f.to_str()).unwrap_or("models");
        let shown = format!("{folder}/{name}.xml");
        let model = match SourceFile::read(&path) {
            Ok(file) => {
                let file = SourceFile::new(shown, file.text());
                match compile_file(&file, &path) {
                    Ok(model) => Some(Arc::new(model)),
                    Err(broken) => {
                        self.findings.extend(broken.findings);
                        self.files.extend(broken.files);
                        None
                    }
                }
            }
            Err(message) => {
                let file = SourceFile::new(shown, "");
                self.findings.push(finding("model-unreadable", 0..0, message).at(&file));
                self.files.push(file);
                None
            }
        };
        self.compiled.insert(name.to_string(), model.clone());
        model
    }
}

/// A model that has mistakes: these, and the files they are in.
#[derive(Debug)]
pub(crate) struct Broken {
    pub(crate) findings: Vec<Finding>,
    pub(crate) files: Vec<SourceFile>,
}

/// Compiles the model of a file. What it names (included text, models to attach, meshes) is looked for beside `path`,
/// and nowhere else.
pub(crate) fn compile_file(file: &SourceFile, path: &Path) -> Result<Model, Broken> {
    let root = path.parent().unwrap_or(Path::new(""));
    let compiled = match Folder::new(root) {
        Ok(folder) => mjcf::compile_with(file.text(), &folder, path.file_name().and_then(|n| n.to_str())),
        Err(_) => mjcf::compile(file.text()),
    };
    compiled.map_err(|list| {
        let mut files = vec![file.clone()];
        let findings = list.iter().map(|d| {
            let at = match &d.file {
                None => 0,
                Some(part) => part_of(&mut files, root, part),
            };
            from_mjcf(d, d.span.clone()).at(&files[at])
        });
        let findings = findings.collect();
        Broken { findings, files }
    })
}

/// The index of a file that a model names in the list, to which it is added the first time. A file that is no text
/// (a mesh) is shown empty.
fn part_of(files: &mut Vec<SourceFile>, root: &Path, part: &str) -> usize {
    let shown = match files.first().and_then(|main| main.path().rsplit_once('/')) {
        Some((folder, _)) => format!("{folder}/{part}"),
        None => part.to_string(),
    };
    if let Some(known) = files.iter().position(|f| **f.path() == *shown) {
        return known;
    }
    let read = SourceFile::read(&root.join(part));
    files.push(SourceFile::new(shown, read.as_ref().map_or("", |f| f.text())));
    files.len() - 1
}

/// An error of a code that is not in the table of lesson rules: the model compiler's, the language's, ours.
pub(crate) fn finding(
    code: &'static str,
    span: std::ops::Range<usize>,
    message: impl Into<String>,
) -> Finding {
    Finding {
        code,
        severity: Severity::Error,
        path: Arc::from(""),
        span,
        message: message.into(),
        why: None,
        help: None,
        fix: None,
        related: Vec::new(),
    }
}

fn inline(d: &MjcfDiagnostic, text: &Text) -> Finding {
    from_mjcf(d, text.span_of(d.span.clone()))
}

/// A mistake in a model, at a place of the file that holds it.
pub fn from_mjcf(d: &MjcfDiagnostic, span: std::ops::Range<usize>) -> Finding {
    Finding { why: d.why.clone(), help: d.help.clone(), ..finding(d.code, span, d.message.clone()) }
}
