//! Files that a model refers to: included text, other models, meshes, height fields.
//!
//! A model may read files under one root only, because lessons may come from untrusted authors. The compiler only requests paths
//! that [`normalize_path`] has normalized. The implementation of [`Files`] determines the root and provides the bytes.

use std::collections::BTreeMap;
use std::io::Read;
use std::path::{Path, PathBuf};

/// Size limit of the text of a model, bytes.
pub const MAX_TEXT: usize = 16 << 20;
/// Size limit of a file that a model refers to, bytes.
pub const MAX_FILE: usize = 64 << 20;

/// A source of the files of a model.
pub trait Files {
    /// The bytes of a file. `path` is relative to the folder of the model, its parts are joined by `/`. It may start with
    /// `..` components and contains no others. The implementation decides whether a file outside the model's folder may be read.
    ///
    /// # Errors
    ///
    /// The reason why the file cannot be read. A file of more than `limit` bytes is refused.
    fn read(&self, path: &str, limit: usize) -> Result<Vec<u8>, FileProblem>;
}

/// The reason why a file could not be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FileProblem {
    /// The model was given as text, without files.
    NoFolder,
    /// There is no such file.
    Missing,
    /// The file is outside the root, or a link leads out of the root.
    Outside,
    /// It has more bytes than the limit allows.
    TooLarge,
    /// The message of the operating system.
    Unreadable(String),
}

/// A source without files, for a model that is given as text.
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

/// The files of a folder and its subfolders. Links are followed if their target is inside the root.
#[derive(Clone, Debug)]
pub struct Folder {
    /// The root, with links resolved. The resolved path of each file must start with it.
    root: PathBuf,
    /// The folder to which paths are relative. It is the root or below it.
    place: PathBuf,
}

impl Folder {
    /// The files below `root`, for a model in `root` itself.
    ///
    /// # Errors
    ///
    /// The folder does not exist, or cannot be accessed.
    pub fn new(root: &Path) -> std::io::Result<Folder> {
        Folder::at(root, root)
    }

    /// The files below `root`, for a model in the folder `place`. If `place` is not below `root`, only the files below `place`
    /// can be read.
    ///
    /// # Errors
    ///
    /// The folder does not exist, or cannot be accessed.
    pub fn at(root: &Path, place: &Path) -> std::io::Result<Folder> {
        let real =
            |path: &Path| if path.as_os_str().is_empty() { Path::new(".") } else { path }.canonicalize();
        let (root, place) = (real(root)?, real(place)?);
        let root = if place.starts_with(&root) { root } else { place.clone() };
        Ok(Folder { root, place })
    }

    /// Whether the components of a path lead out of the root. Files outside the root are not accessed at all.
    fn leaves_root(&self, path: &str) -> bool {
        let up = path.split('/').take_while(|part| *part == "..").count();
        let deep = self.place.strip_prefix(&self.root).map_or(0, |below| below.components().count());
        up > deep
    }
}

impl Files for Folder {
    fn read(&self, path: &str, limit: usize) -> Result<Vec<u8>, FileProblem> {
        let problem = |e: std::io::Error| match e.kind() {
            std::io::ErrorKind::NotFound => FileProblem::Missing,
            _ => FileProblem::Unreadable(e.to_string()),
        };
        if self.leaves_root(path) {
            return Err(FileProblem::Outside);
        }
        let real = self.place.join(path).canonicalize().map_err(problem)?;
        if !real.starts_with(&self.root) {
            return Err(FileProblem::Outside);
        }
        // A pipe or a device could block the reader indefinitely.
        if !real.metadata().map_err(problem)?.is_file() {
            return Err(FileProblem::Unreadable("it is not a file".into()));
        }
        let mut bytes = Vec::new();
        // Reads one byte more than the limit, to detect a file that is too large whatever its metadata state.
        let file = std::fs::File::open(real).map_err(problem)?;
        file.take(limit as u64 + 1).read_to_end(&mut bytes).map_err(problem)?;
        if bytes.len() > limit { Err(FileProblem::TooLarge) } else { Ok(bytes) }
    }
}

/// The normalized form of a path in the text of a file in `folder`: relative to the folder of the model, parts joined by
/// `/`, `..` at the start only. `None` if the path is empty or absolute.
pub(crate) fn normalize_path(folder: &str, written: &str) -> Option<String> {
    // Paths with a drive or a stream (`C:`, `file:x`) are treated as absolute.
    if written.is_empty() || written.starts_with(['/', '\\']) || written.contains([':', '\0']) {
        return None;
    }
    let mut parts: Vec<&str> = Vec::new();
    for part in folder.split('/').chain(written.split(['/', '\\'])) {
        match part {
            "" | "." => {}
            ".." if parts.last().is_some_and(|last| *last != "..") => {
                parts.pop();
            }
            part => parts.push(part),
        }
    }
    if parts.last().is_none_or(|last| *last == "..") { None } else { Some(parts.join("/")) }
}

/// The folder of a normalized path.
pub(crate) fn folder_of(path: &str) -> &str {
    path.rsplit_once('/').map_or("", |(folder, _)| folder)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_have_one_form() {
        for (folder, written, expected) in [
            ("", "a.xml", Some("a.xml")),
            ("", "./parts//a.xml", Some("parts/a.xml")),
            ("parts", "a.xml", Some("parts/a.xml")),
            ("parts", "../b\\c.stl", Some("b/c.stl")),
            ("", "parts/../a.xml", Some("a.xml")),
            ("", "../a.xml", Some("../a.xml")),
            ("parts", "../../a.xml", Some("../a.xml")),
            ("../parts", "../a.xml", Some("../a.xml")),
            ("", "parts/../../parts/a.xml", Some("../parts/a.xml")),
            ("", "..", None),
            ("", "/etc/passwd", None),
            ("", "\\\\server\\share", None),
            ("", "C:/a.xml", None),
            ("", "a\0.xml", None),
            ("", "", None),
            ("", ".", None),
        ] {
            assert_eq!(normalize_path(folder, written).as_deref(), expected, "{folder} {written}");
        }
    }

    #[test]
    fn a_sister_folder_below_the_root_is_readable_and_folders_above_are_not() {
        let outer = tempfile::tempdir().unwrap();
        let root = outer.path().join("course");
        std::fs::create_dir_all(root.join("models/deep")).unwrap();
        std::fs::create_dir(root.join("stls")).unwrap();
        std::fs::write(root.join("stls/x.stl"), "x").unwrap();
        std::fs::write(outer.path().join("secret"), "s").unwrap();
        let files = Folder::at(&root, &root.join("models")).unwrap();
        assert_eq!(files.read("../stls/x.stl", 9), Ok(b"x".to_vec()));
        assert_eq!(files.read("deep/../../stls/x.stl", 9), Ok(b"x".to_vec()));
        // The error for a file above the root does not reveal whether the file exists.
        for path in ["../../secret", "../../nothing", "deep/../../../secret"] {
            let read = files.read(path, 9);
            assert!(matches!(read, Err(FileProblem::Outside)), "{path}: {read:?}");
        }
        // If the root does not contain the model, only the model's own folder can be read.
        let separate = Folder::at(&root.join("stls"), &root.join("models")).unwrap();
        assert_eq!(separate.read("../stls/x.stl", 9), Err(FileProblem::Outside));
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
