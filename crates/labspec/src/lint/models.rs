//! The folder of models that lessons name, and the root below which files may be opened. The folder is listed once.

use crate::models::Models;
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The models a lesson may name.
#[derive(Clone, Default)]
pub struct ModelFolder {
    /// `None` when only names of models are known, or nothing.
    folder: Option<PathBuf>,
    /// The root for files that models read: nothing outside of it is ever opened.
    root: PathBuf,
    /// Names without extension, sorted; `None` when they are unknown, so that no model is reported as missing.
    names: Option<Vec<String>>,
    /// Models of the embedding program, without a folder.
    given: Option<Arc<dyn Models>>,
}

impl fmt::Debug for ModelFolder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ModelFolder { folder, root, names, given } = self;
        let mut debug = f.debug_struct("ModelFolder");
        debug.field("folder", folder).field("root", root).field("names", names);
        debug.field("given", &given.is_some()).finish()
    }
}

impl<M: Models + 'static> From<M> for ModelFolder {
    /// Models of the embedding program replace a folder.
    fn from(models: M) -> ModelFolder {
        let mut names = models.names();
        names.iter_mut().for_each(|names| names.sort());
        ModelFolder { names, given: Some(Arc::new(models)), ..ModelFolder::default() }
    }
}

impl ModelFolder {
    /// No folder is known: names of models are not checked.
    pub fn unknown() -> ModelFolder {
        ModelFolder::default()
    }

    /// Models known by name only.
    pub fn with_names<S: Into<String>>(names: impl IntoIterator<Item = S>) -> ModelFolder {
        let mut names: Vec<String> = names.into_iter().map(Into::into).collect();
        names.sort();
        ModelFolder { names: Some(names), ..ModelFolder::default() }
    }

    /// Lists the `.xml` files of a folder, which is also the root.
    ///
    /// # Errors
    /// The folder cannot be read.
    pub fn open(folder: &Path) -> std::io::Result<ModelFolder> {
        ModelFolder::below(folder, folder)
    }

    /// Lists the `.xml` files of a folder below a root. Links that leave the root are skipped. If the root does not contain
    /// the folder, the folder is the root.
    ///
    /// # Errors
    /// The folder cannot be read.
    pub fn below(root: &Path, folder: &Path) -> std::io::Result<ModelFolder> {
        let folder = folder.canonicalize()?;
        let root = root.canonicalize().ok().filter(|root| folder.starts_with(root)).unwrap_or(folder.clone());
        let mut names = Vec::new();
        for entry in std::fs::read_dir(&folder)? {
            let path = entry?.path();
            let inside = path.canonicalize().is_ok_and(|real| real.starts_with(&root) && real.is_file());
            if inside
                && path.extension().is_some_and(|e| e == "xml")
                && let Some(stem) = path.file_stem().and_then(|s| s.to_str())
            {
                names.push(stem.to_string());
            }
        }
        names.sort();
        Ok(ModelFolder { folder: Some(folder), root, names: Some(names), given: None })
    }

    /// Adds the names of unsaved models of the folder.
    pub fn with_unsaved(mut self, files: Vec<String>) -> ModelFolder {
        if let Some(names) = &mut self.names {
            names.extend(files.iter().filter_map(|file| file.strip_suffix(".xml")).map(String::from));
            names.sort();
            names.dedup();
        }
        self
    }

    /// The nearest folder `models` beside a lesson or above it; unknown when there is none. The root is determined by
    /// [`root_of`]: `labspec.toml`, else the repository.
    pub fn near(lesson: &Path) -> ModelFolder {
        let open = |folder: PathBuf| ModelFolder::below(&root_of(&folder, &[lesson_folder(lesson)]), &folder);
        ModelFolder::find_near(lesson).and_then(|folder| open(folder).ok()).unwrap_or_default()
    }

    /// The folder `models` beside a lesson or above it.
    pub fn find_near(lesson: &Path) -> Option<PathBuf> {
        let place = located(lesson);
        let mut folders = place.ancestors().skip(1).map(|folder| folder.join("models"));
        folders.find(|f| f.is_dir())
    }

    /// The root: models may read files below it. Empty when no folder is known.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// The folder; `None` when only names of models are known, or nothing.
    pub fn path_of_folder(&self) -> Option<&Path> {
        self.folder.as_deref()
    }

    /// The names, sorted; `None` when no folder is known.
    pub fn names(&self) -> Option<&[String]> {
        self.names.as_deref()
    }

    /// The models of the embedding program that replace a folder.
    pub(crate) fn given(&self) -> Option<&dyn Models> {
        self.given.as_deref()
    }

    /// Whether there is a model of this name.
    pub(crate) fn has(&self, name: &str) -> bool {
        self.given.as_ref().map_or(self.path(name).is_some(), |models| models.text(name).is_some())
    }

    /// The file of a model; `None` when the folder has no such model.
    pub fn path(&self, name: &str) -> Option<PathBuf> {
        let names = self.names.as_ref()?;
        // Only listed names are opened, so no separators, `..` or absolute paths can get here.
        let found = names.iter().find(|n| *n == name)?;
        Some(self.folder.as_ref()?.join(format!("{found}.xml")))
    }
}

/// The folder of a file.
pub fn lesson_folder(file: &Path) -> PathBuf {
    located(file).parent().unwrap_or(Path::new("")).to_path_buf()
}

/// The path of a file with symbolic links resolved. For a file that does not exist yet (a new text of an editor, standard
/// input), the folder is resolved.
fn located(file: &Path) -> PathBuf {
    let folder = || match file.parent() {
        Some(folder) if folder != Path::new("") => folder.canonicalize(),
        _ => Path::new(".").canonicalize(),
    };
    let new = || Some(folder().ok()?.join(file.file_name()?));
    file.canonicalize().ok().or_else(new).unwrap_or_else(|| file.to_path_buf())
}

/// The file that marks the root of a course.
pub(crate) const ROOT_FILE: &str = "labspec.toml";

/// The root for models of a folder. It is the nearest folder above them that contains `labspec.toml`; else the nearest that
/// is a repository (`.git`) or contains unpacked packages (`*.dist-info`); else the outermost of the folders that the user
/// named, if the models are inside it; else the folder of the models.
pub fn root_of(models: &Path, named: &[PathBuf]) -> PathBuf {
    let real = models.canonicalize().unwrap_or_else(|_| models.to_path_buf());
    let marked = real.ancestors().find(|folder| folder.join(ROOT_FILE).is_file());
    let project = || real.ancestors().find(|folder| folder.join(".git").exists() || holds_packages(folder));
    if let Some(found) = marked.or_else(project) {
        return found.to_path_buf();
    }
    let around = named.iter().filter_map(|folder| folder.canonicalize().ok()).filter(|f| real.starts_with(f));
    around.min_by_key(|f| f.components().count()).unwrap_or(real)
}

/// Whether a folder contains unpacked packages, as in a Python environment: models are stored with their meshes there.
fn holds_packages(folder: &Path) -> bool {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    entries.take(MOST_ENTRIES).any(|entry| entry.path().extension().is_some_and(|e| e == "dist-info"))
}

/// Maximum number of entries of a folder that are read.
const MOST_ENTRIES: usize = 100_000;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_files_of_the_folder_can_be_named() {
        let outside = tempfile::tempdir().unwrap();
        std::fs::write(outside.path().join("secret.xml"), "").unwrap();
        let folder = outside.path().join("models");
        std::fs::create_dir(&folder).unwrap();
        std::fs::write(folder.join("ball.xml"), "").unwrap();
        std::fs::write(folder.join("notes.txt"), "").unwrap();
        #[cfg(unix)]
        std::os::unix::fs::symlink(outside.path().join("secret.xml"), folder.join("link.xml")).unwrap();
        let models = ModelFolder::open(&folder).unwrap();
        assert_eq!(models.names().unwrap(), ["ball"]);
        assert!(models.path("ball").unwrap().ends_with("models/ball.xml"));
        for name in ["../secret", "/etc/passwd", "link", "ball.xml", ""] {
            assert_eq!(models.path(name), None, "{name}");
        }
        // Beside a lesson, the folder of the lesson is the root, and the linked file is below it.
        let near = ModelFolder::near(&outside.path().join("lesson.md"));
        assert_eq!(near.names().unwrap(), ["ball", "link"]);
    }

    #[test]
    fn the_root_is_the_folder_named_by_the_user() {
        let outer = tempfile::tempdir().unwrap();
        let top = outer.path().canonicalize().unwrap();
        let models = top.join("course/week/models");
        std::fs::create_dir_all(&models).unwrap();
        // Without markers: the folder of the models, or the named folder that contains it.
        assert_eq!(root_of(&models, &[]), models);
        assert_eq!(
            root_of(&models, &[top.join("course/week"), top.join("elsewhere")]),
            top.join("course/week")
        );
        assert_eq!(root_of(&models, &[top.join("course"), top.join("course/week")]), top.join("course"));
        // An unpacked package, then a repository; `labspec.toml` takes precedence wherever it is.
        std::fs::create_dir(top.join("course/robot-1.0.dist-info")).unwrap();
        assert_eq!(root_of(&models, &[]), top.join("course"));
        std::fs::create_dir(top.join("course/week/.git")).unwrap();
        assert_eq!(root_of(&models, &[]), top.join("course/week"));
        std::fs::write(top.join("labspec.toml"), "").unwrap();
        assert_eq!(root_of(&models, &[]), top);
        assert_eq!(ModelFolder::near(&top.join("course/week/a.md")).root(), top);
    }

    #[cfg(unix)]
    #[test]
    fn links_below_the_root_are_models() {
        let outer = tempfile::tempdir().unwrap();
        let top = outer.path().canonicalize().unwrap();
        std::fs::create_dir_all(top.join("course/models")).unwrap();
        std::fs::write(top.join("course/shared.xml"), "").unwrap();
        std::fs::write(top.join("secret.xml"), "").unwrap();
        std::os::unix::fs::symlink("../shared.xml", top.join("course/models/link.xml")).unwrap();
        std::os::unix::fs::symlink("../../secret.xml", top.join("course/models/leak.xml")).unwrap();
        let models = ModelFolder::below(&top.join("course"), &top.join("course/models")).unwrap();
        assert_eq!(models.names().unwrap(), ["link"]);
    }
}
