//! The models of labs: from the model folder or from the lab itself, with a location for every error.

use super::Functions;
use super::model_file::{FilesAround, compile_source, read_file};
use super::parts::{self, Hash, ModelFile};
use crate::finding::{Finding, InFile, Severity};
use crate::lint::{ModelFolder, root_of};
use crate::models::{self, FilesOf};
use crate::rules;
use crate::source::{self, SourceFile, Sources, Text};
use crate::spec::format::RequestedNames;
use crate::spec::{Lab, ModelSource};
use labspec_core::xml::{self, Files, Folder, NoFiles, Patch, Refusal};
use labspec_core::{Model, Obj};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

pub use super::model_file::Compiled;
pub use super::model_file::compile_file;
pub use super::model_file::{check_model_file, from_mjcf};

/// Models by name, compiled once, and their files. Threads may share them: the first request compiles, the others wait.
#[derive(Debug, Default)]
pub struct Models {
    folder: ModelFolder,
    compiled: Mutex<BTreeMap<String, Arc<OnceLock<Loaded>>>>,
    /// The findings about each model, until they are taken.
    reported: Mutex<BTreeMap<String, ModelDiagnostics>>,
    /// Functions of the embedding program, which labs may call.
    functions: Functions,
    /// Computes digests of the files; `None` without a cache of results.
    hash: Option<Hash>,
    /// Unsaved texts that replace files of the folder.
    sources: Sources,
    /// Digests of parts, computed once.
    marks: Mutex<BTreeMap<(String, bool, usize), String>>,
    /// The files of the models whose findings were taken.
    files: Vec<SourceFile>,
}

/// The findings about a model, and the files to which they refer.
type ModelDiagnostics = (Vec<Finding>, Vec<SourceFile>);

/// A loaded model of the folder.
#[derive(Debug)]
struct Loaded {
    model: Option<Arc<Model>>,
    /// Whether its files have findings.
    has_diagnostics: bool,
    parts: Vec<ModelFile>,
}

/// Locks a mutex, even if a thread panicked while it held the lock.
fn lock_cache<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Models {
    /// The models of a folder. Nothing is read yet.
    pub fn new(folder: ModelFolder) -> Models {
        Models { folder, ..Models::default() }
    }

    /// The models of a folder for a cache of results: a digest of every file that is read is stored, see [`Models::parts`].
    pub fn with_hash(folder: ModelFolder, hash: Hash) -> Models {
        Models { folder, hash: Some(hash), ..Models::default() }
    }

    /// Sets the functions of the embedding program that labs may call.
    pub fn with_functions(self, functions: Functions) -> Models {
        Models { functions, ..self }
    }

    /// Sets the sources: unsaved texts of an editor replace files.
    pub fn with_sources(self, sources: Sources) -> Models {
        Models { sources, ..self }
    }

    /// Functions of the embedding program.
    pub fn functions(&self) -> &Functions {
        &self.functions
    }

    /// The folder.
    pub fn folder(&self) -> &ModelFolder {
        &self.folder
    }

    /// The files of the models with findings that were taken.
    pub fn files(&self) -> &[SourceFile] {
        &self.files
    }

    /// Takes the findings in model files since the last call, in the order of the names of the models.
    pub fn take_findings(&mut self) -> Vec<Finding> {
        let mut findings = Vec::new();
        for (of_model, files) in std::mem::take(&mut *lock_cache(&self.reported)).into_values() {
            findings.extend(of_model);
            self.files.extend(files);
        }
        findings
    }

    /// The model of a lab. `None` when there is none or it has errors. Errors in an inline model are added to `findings`,
    /// those in a model file to the findings of the models, once.
    pub fn model_of_lab(&self, lab: &Lab, findings: &mut Vec<Finding>) -> Option<Arc<Model>> {
        match lab.scene()? {
            ModelSource::Xml(text) => {
                let checked = xml::check_xml(&text.value, &NoFiles, None);
                findings.extend(checked.findings.iter().map(|d| inline(d, text)));
                checked.model.map(Arc::new)
            }
            ModelSource::Model(name) => {
                let model = self.load(&name.value);
                // A missing model is reported by the rules about the structure of the lesson.
                if model.is_none() && self.folder.has(&name.value) {
                    findings.push(
                        Finding::error(rules::MODEL_BROKEN, name.span(), format!("the model `{}` has errors", name.value))
                            .why("until the model loads, this lab cannot run and its expressions cannot be checked")
                            .help(format!("fix what is reported for {}.xml", name.value)),
                    );
                }
                model
            }
        }
    }

    /// The text of the model of a lab with modifications and with its includes expanded, for another program.
    pub fn written(&self, lab: &Lab, patches: &[Patch]) -> Option<String> {
        self.texts(lab, |text, files, path| xml::to_xml(text, files, path, patches))?
    }

    /// The model of a lab with modifications of its text, made before it is compiled.
    ///
    /// # Errors
    /// The index of a modification that cannot be made, and why; or that the modified model is invalid.
    pub fn changed(&self, lab: &Lab, patches: &[Patch]) -> Result<Arc<Model>, (Option<usize>, Refusal)> {
        let unreadable =
            || (None, Refusal { message: "the model cannot be read".into(), help: String::new() });
        let (checked, refusals) = self
            .texts(lab, |text, files, path| xml::check_patched(text, files, path, patches))
            .ok_or_else(unreadable)?;
        if let Some((i, refusal)) = refusals.into_iter().enumerate().find_map(|(i, r)| Some((i, r?))) {
            return Err((Some(i), refusal));
        }
        checked.model.map(Arc::new).ok_or_else(|| {
            let first = checked.findings.into_iter().find(|f| f.severity == Severity::Error);
            let message = first.map_or("the changed model is invalid".into(), |f| f.message);
            (None, Refusal { message, help: "change it to a value that the model accepts".into() })
        })
    }

    /// Calls `read` with the text of a lab's model, the files that it names, and its own name among them. `None` when it
    /// cannot be read.
    fn texts<T>(&self, lab: &Lab, read: impl FnOnce(&str, &dyn Files, Option<&str>) -> T) -> Option<T> {
        let name = match lab.scene()? {
            ModelSource::Xml(text) => return Some(read(&text.value, &NoFiles, None)),
            ModelSource::Model(name) => &name.value,
        };
        let file = Some(format!("{name}.xml"));
        if let Some(given) = self.folder.given() {
            return Some(read(&given.text(name)?, &FilesOf(given), file.as_deref()));
        }
        let path = self.folder.path(name)?;
        let text = read_file(&path, &self.sources).ok()?;
        let files = FilesAround::below(&path, self.folder.root(), &self.sources);
        Some(read(text.text(), &files, file.as_deref()))
    }

    /// The model with this name; `None` when there is none or it has errors, which are then findings of the models.
    pub fn load(&self, name: &str) -> Option<Arc<Model>> {
        self.loaded(name, |loaded| loaded.model.clone())?
    }

    /// The findings of a model text that is being edited. Other files come from where these models come from.
    pub fn check_text(&self, file: &SourceFile, path: &Path) -> Vec<Finding> {
        if let Some(given) = self.folder.given() {
            let name = path.strip_prefix("models").unwrap_or(path).to_str();
            return compile_source(file, &FilesOf(given), name, None, xml::check_xml).findings;
        }
        let folder = path.parent().unwrap_or(Path::new(""));
        let find = || Some(root_of(folder, &[]));
        let root = self.sources.place(source::PathQuery::Root, folder, find).unwrap_or_default();
        compile_file(file, path, &root, &self.sources, None).findings
    }

    /// The names for completions in a lesson ([`crate::spec::format::completions`]).
    pub fn names(&self, asked: RequestedNames<'_>) -> Vec<String> {
        let sites = |model: &Model| {
            let named = model.names.of_kind(Obj::Site).iter().filter(|name| !name.is_empty());
            named.cloned().collect()
        };
        match asked {
            RequestedNames::Models => self.folder.names().unwrap_or_default().to_vec(),
            RequestedNames::SitesOf(name) => self.load(name).map_or_else(Vec::new, |model| sites(&model)),
            RequestedNames::SitesIn(xml) => {
                xml::check_xml(xml, &NoFiles, None).model.map_or_else(Vec::new, |model| sites(&model))
            }
        }
    }

    /// The files of a model in the folder, and whether it has findings. The files are known only with
    /// [`Models::with_hash`].
    pub fn parts(&self, name: &str) -> Option<(Vec<ModelFile>, bool)> {
        self.loaded(name, |loaded| (loaded.parts.clone(), loaded.has_diagnostics))
    }

    /// The paths of every file that was read, and of the folder.
    pub fn read(&self) -> Vec<PathBuf> {
        let Some(folder) = self.folder.path_of_folder() else { return Vec::new() };
        let mut paths = vec![folder.to_path_buf()];
        let compiled = lock_cache(&self.compiled);
        for (name, loaded) in compiled.iter() {
            paths.extend(self.folder.path(name));
            paths.extend(loaded.get().into_iter().flat_map(|l| l.parts.iter().map(|p| folder.join(&p.path))));
        }
        paths.extend(lock_cache(&self.marks).keys().map(|(part, ..)| folder.join(part)));
        paths
    }

    fn loaded<T>(&self, name: &str, what: impl Fn(&Loaded) -> T) -> Option<T> {
        let cached = lock_cache(&self.compiled).get(name).cloned();
        let cell = match cached {
            Some(cell) => cell,
            None if self.folder.has(name) => {
                lock_cache(&self.compiled).entry(name.to_string()).or_default().clone()
            }
            None => return None,
        };
        let compile = || match (self.folder.given(), self.folder.path(name)) {
            (Some(models), _) => self.compile_given(name, models),
            (None, path) => self.compile(name, &path.unwrap_or_default()),
        };
        Some(what(cell.get_or_init(compile)))
    }

    /// A model that is not a file: no other file is opened for it, and it is not cached.
    fn compile_given(&self, name: &str, models: &dyn models::Models) -> Loaded {
        let text = models.text(name).unwrap_or_default();
        let file = SourceFile::new(format!("models/{name}.xml"), text);
        let Compiled { model, findings, files, parts } =
            compile_source(&file, &FilesOf(models), Some(&format!("{name}.xml")), None, xml::check_xml);
        let has_diagnostics = !findings.is_empty();
        lock_cache(&self.reported).insert(name.to_string(), (findings, files));
        Loaded { model: model.map(Arc::new), has_diagnostics, parts }
    }

    fn compile(&self, name: &str, path: &Path) -> Loaded {
        // The folder and the file identify it, and are the same on every machine.
        let folder = path.parent().and_then(|p| p.file_name()).and_then(|f| f.to_str()).unwrap_or("models");
        let file_name = format!("{folder}/{name}.xml");
        let read = read_file(path, &self.sources);
        let text = read.as_ref().map(SourceFile::text).map_err(String::as_str);
        let main_file =
            |hash| ModelFile { path: String::new(), limit: 0, hash: parts::hash_text(hash, text) };
        let mut made_of: Vec<ModelFile> = self.hash.map(main_file).into_iter().collect();
        let (model, findings, files) = match read {
            Ok(file) => {
                let file = SourceFile::new(file_name, file.text());
                let compiled = compile_file(&file, path, self.folder.root(), &self.sources, self.hash);
                made_of.extend(compiled.parts);
                (compiled.model.map(Arc::new), compiled.findings, compiled.files)
            }
            Err(message) => {
                let file = SourceFile::new(file_name, "");
                (None, vec![Finding::error(rules::MODEL_UNREADABLE, 0..0, message).at(&file)], vec![file])
            }
        };
        let has_diagnostics = !findings.is_empty();
        lock_cache(&self.reported).insert(name.to_string(), (findings, files));
        Loaded { model, has_diagnostics, parts: made_of }
    }

    /// Whether the files of a model are unchanged.
    pub fn is_made_of(&self, name: &str, parts: &[ModelFile]) -> bool {
        let (Some(path), Some(hash)) = (self.folder.path(name), self.hash) else { return false };
        let place = path.parent().unwrap_or(Path::new(""));
        let folder = Folder::at(self.folder.root(), place).ok();
        let files: &dyn Files = folder.as_ref().map_or(&NoFiles, |folder| folder);
        parts.iter().any(|part| part.path.is_empty())
            && parts.iter().all(|part| {
                let named = if part.path.is_empty() { format!("{name}.xml") } else { part.path.clone() };
                // The text of a model and the bytes of the same file, when it is attached, have different digests.
                let key = (named, part.path.is_empty(), part.limit);
                let cached = lock_cache(&self.marks).get(&key).cloned();
                let current = cached.unwrap_or_else(|| {
                    let current = parts::hash_now(hash, &path, files, &part.path, part.limit);
                    lock_cache(&self.marks).insert(key, current.clone());
                    current
                });
                current == part.hash
            })
    }
}

fn inline(d: &Finding, text: &Text) -> Finding {
    from_mjcf(d, text.span_of(d.span.clone()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spec::format::completions_in;

    const TETRAHEDRON: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

    fn model(mesh: &str) -> String {
        format!(
            "<mujoco><asset><mesh name='m' file='{mesh}'/></asset>\n<worldbody>> <geom type='mesh' mesh='m'/></worldbody></mujoco>"
        )
    }

    /// A mesh in a sibling folder is opened when the root contains both folders. A file outside of it is an error that
    /// states how to widen the root.
    #[test]
    fn a_model_reads_files_below_the_root() {
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
        // A warning is reported, and does not stop compilation.
        let [warning] = findings.as_slice() else { panic!("{findings:?}") };
        assert_eq!((warning.code, warning.severity), ("mjcf-text", Severity::Warning));
        assert_eq!(files[0].slice(warning.span.clone()), ">");
    }

    /// The warnings of a lab's model are reported once in the model's file, and the lab has its model.
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

    /// Completions for `trail` list the sites of the lab's model, from the folder or from the lab itself.
    #[test]
    fn completions_list_the_sites_of_a_model() {
        let top = tempfile::tempdir().unwrap();
        let model = "<mujoco><worldbody><site name='tip'/><site/><body name='b'><geom size='1'/><site name='top'/></body></worldbody></mujoco>";
        std::fs::write(top.path().join("rod.xml"), model).unwrap();
        let models = Models::new(ModelFolder::open(top.path()).unwrap());
        let offered = |lab: &str| {
            let offset = lab.find('|').unwrap();
            let text = format!("```lab simlab\n{}\n```\n", lab.replace('|', ""));
            let file = SourceFile::new("t.md", text);
            let all = completions_in(&file, offset + "```lab simlab\n".len(), &|asked| models.names(asked));
            all.into_iter().map(|c| c.text.into_owned()).collect::<Vec<_>>()
        };
        assert_eq!(offered(r#"{"model": "|"}"#), ["rod"]);
        assert_eq!(offered(r#"{"model": "rod", "trail": "|"}"#), ["tip", "top"]);
        assert_eq!(offered(&format!(r#"{{"xml": "{model}", "trail": "to|"}}"#)), ["top"]);
        for none in [r#"{"model": "rid", "trail": "|"}"#, r#"{"xml": "<mujoco", "trail": "|"}"#] {
            assert_eq!(offered(none), Vec::<String>::new());
        }
    }
}
