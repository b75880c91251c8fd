//! The folder of models that lessons name. It is listed once; nothing outside it is ever opened.

use std::path::{Path, PathBuf};

/// The models a lesson may name.
#[derive(Clone, Debug, Default)]
pub struct ModelFolder {
    /// `None` when models are only known by name, or not at all.
    root: Option<PathBuf>,
    /// Names without extension, sorted; `None` when nothing is known, so that nothing can be missing.
    names: Option<Vec<String>>,
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
        ModelFolder { root: None, names: Some(names) }
    }

    /// Lists the `.xml` files of a folder. Links that lead out of it are left out.
    ///
    /// # Errors
    /// The folder cannot be read.
    pub fn open(folder: &Path) -> std::io::Result<ModelFolder> {
        let root = folder.canonicalize()?;
        let mut names = Vec::new();
        for entry in std::fs::read_dir(&root)? {
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
        Ok(ModelFolder { root: Some(root), names: Some(names) })
    }

    /// The folder `models` beside a lesson or above it, whichever is nearer; unknown when there is none.
    pub fn near(lesson: &Path) -> ModelFolder {
        let absolute = lesson.canonicalize().unwrap_or_else(|_| lesson.to_path_buf());
        let mut folders = absolute.ancestors().skip(1).map(|folder| folder.join("models"));
        folders.find(|f| f.is_dir()).and_then(|f| ModelFolder::open(&f).ok()).unwrap_or_default()
    }

    /// The names, sorted; `None` when no folder is known.
    pub fn names(&self) -> Option<&[String]> {
        self.names.as_deref()
    }

    /// The file of a model; `None` when the folder has no such model.
    pub fn path(&self, name: &str) -> Option<PathBuf> {
        let names = self.names.as_ref()?;
        // Only what was listed is opened: no separators, no `..`, no absolute paths can get here.
        let found = names.iter().find(|n| *n == name)?;
        Some(self.root.as_ref()?.join(format!("{found}.xml")))
    }
}

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
        let near = ModelFolder::near(&outside.path().join("lesson.md"));
        assert_eq!(near.names().unwrap(), ["ball"]);
    }
}
