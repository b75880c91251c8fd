//! Files that a model names: included text, other models, meshes, height fields.
//!
//! A model may read what lies in its own folder and below, and nothing else: lessons come from strangers. The
//! compiler only ever asks for a path that [`inside`] has cleaned; where the bytes come from is decided by
//! whoever implements [`Files`].

use std::collections::BTreeMap;
use std::io::Read;
use std::path::{Path, PathBuf};

/// Largest file that a model may name, bytes.
pub const MAX_FILE: usize = 64 << 20;

/// Where the files of a model come from.
pub trait Files {
    /// The bytes of a file. `path` is relative to the folder of the model, its parts joined by `/`, and never
    /// leads out of that folder.
    ///
    /// # Errors
    ///
    /// Why there are no bytes; more than `limit` of them are refused.
    fn read(&self, path: &str, limit: usize) -> Result<Vec<u8>, FileProblem>;
}

/// Why a file could not be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FileProblem {
    /// The model was given as text alone.
    NoFolder,
    /// There is no such file.
    Missing,
    /// A link leads out of the folder of the model.
    Outside,
    /// It has more bytes than the limit allows.
    TooLarge,
    /// What the operating system said.
    Unreadable(String),
}

/// No files at all: a model that is given as text.
#[derive(Clone, Copy, Debug)]
pub struct NoFiles;

impl Files for NoFiles {
    fn read(&self, _: &str, _: usize) -> Result<Vec<u8>, FileProblem> {
        Err(FileProblem::NoFolder)
    }
}

/// Files in memory, by path.
impl Files for BTreeMap<String, Vec<u8>> {
    fn read(&self, path: &str, limit: usize) -> Result<Vec<u8>, FileProblem> {
        match self.get(path) {
            None => Err(FileProblem::Missing),
            Some(bytes) if bytes.len() > limit => Err(FileProblem::TooLarge),
            Some(bytes) => Ok(bytes.clone()),
        }
    }
}

/// The files of a folder and the folders in it. Links are followed as long as they stay inside.
#[derive(Clone, Debug)]
pub struct Folder {
    /// Without links: what a file's real path must begin with.
    root: PathBuf,
}

impl Folder {
    /// The files below `root`.
    ///
    /// # Errors
    ///
    /// There is no such folder, or it cannot be reached.
    pub fn new(root: &Path) -> std::io::Result<Folder> {
        let root = if root.as_os_str().is_empty() { Path::new(".") } else { root };
        Ok(Folder { root: root.canonicalize()? })
    }
}

impl Files for Folder {
    fn read(&self, path: &str, limit: usize) -> Result<Vec<u8>, FileProblem> {
        let problem = |e: std::io::Error| match e.kind() {
            std::io::ErrorKind::NotFound => FileProblem::Missing,
            _ => FileProblem::Unreadable(e.to_string()),
        };
        let real = self.root.join(path).canonicalize().map_err(problem)?;
        if !real.starts_with(&self.root) {
            return Err(FileProblem::Outside);
        }
        // A pipe or a device could keep the reader waiting for ever.
        if !real.metadata().map_err(problem)?.is_file() {
            return Err(FileProblem::Unreadable("it is not a file".into()));
        }
        let mut bytes = Vec::new();
        // One byte more than the limit tells a file that is too large, whatever its metadata say.
        let file = std::fs::File::open(real).map_err(problem)?;
        file.take(limit as u64 + 1).read_to_end(&mut bytes).map_err(problem)?;
        if bytes.len() > limit { Err(FileProblem::TooLarge) } else { Ok(bytes) }
    }
}

/// The clean form of a path that an author wrote, seen from `folder`: relative to the folder of the model, parts
/// joined by `/`. `None` when it is empty, absolute, or leads out.
pub(crate) fn inside(folder: &str, written: &str) -> Option<String> {
    let mut parts: Vec<&str> = folder.split('/').filter(|p| !p.is_empty()).collect();
    // Drives and streams (`C:`, `file:x`) are absolute in other words.
    if written.is_empty() || written.starts_with(['/', '\\']) || written.contains([':', '\0']) {
        return None;
    }
    for part in written.split(['/', '\\']) {
        match part {
            "" | "." => {}
            ".." => {
                parts.pop()?;
            }
            part => parts.push(part),
        }
    }
    if parts.is_empty() { None } else { Some(parts.join("/")) }
}

/// The folder of a clean path.
pub(crate) fn folder_of(path: &str) -> &str {
    path.rsplit_once('/').map_or("", |(folder, _)| folder)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_stay_inside() {
        for (folder, written, clean) in [
            ("", "a.xml", Some("a.xml")),
            ("", "./parts//a.xml", Some("parts/a.xml")),
            ("parts", "a.xml", Some("parts/a.xml")),
            ("parts", "../b\\c.stl", Some("b/c.stl")),
            ("", "parts/../a.xml", Some("a.xml")),
            ("", "../a.xml", None),
            ("parts", "../../a.xml", None),
            ("", "parts/../../parts/a.xml", None),
            ("", "/etc/passwd", None),
            ("", "\\\\server\\share", None),
            ("", "C:/a.xml", None),
            ("", "a\0.xml", None),
            ("", "", None),
            ("", ".", None),
        ] {
            assert_eq!(inside(folder, written).as_deref(), clean, "{folder} {written}");
        }
    }

    #[cfg(unix)]
    #[test]
    fn links_that_lead_out_are_refused() {
        let outer = tempfile::tempdir().unwrap();
        let inner = outer.path().join("lesson");
        std::fs::create_dir(&inner).unwrap();
        std::fs::write(outer.path().join("secret"), "x").unwrap();
        std::fs::write(inner.join("own"), "own").unwrap();
        std::os::unix::fs::symlink("../secret", inner.join("leak")).unwrap();
        std::os::unix::fs::symlink("..", inner.join("up")).unwrap();
        std::os::unix::fs::symlink("own", inner.join("alias")).unwrap();
        std::os::unix::fs::symlink("/dev/zero", inner.join("endless")).unwrap();
        let files = Folder::new(&inner).unwrap();
        assert_eq!(files.read("own", 10), Ok(b"own".to_vec()));
        assert_eq!(files.read("alias", 10), Ok(b"own".to_vec()));
        assert_eq!(files.read("own", 2), Err(FileProblem::TooLarge));
        assert_eq!(files.read("none", 10), Err(FileProblem::Missing));
        for path in ["leak", "up/secret", "endless"] {
            assert_eq!(files.read(path, 10), Err(FileProblem::Outside), "{path}");
        }
        assert!(matches!(files.read("", 10), Err(FileProblem::Unreadable(_))));
    }
}
