//! The sources of a lesson's related files: its snapshot, the lessons whose labs it names, the files to which it links, and
//! unsaved model texts of an editor.

use super::read_text;
use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The source of texts.
#[derive(Clone, Debug)]
pub enum Sources {
    /// Only texts in memory, by their paths: no file is read.
    Given(Arc<BTreeMap<PathBuf, String>>),
    /// Saved files.
    Disk,
    /// Unsaved texts of an editor, and saved files for all other paths.
    Over(Arc<Overlay>),
}

impl Default for Sources {
    /// Only the lesson itself.
    fn default() -> Sources {
        Sources::Given(Arc::default())
    }
}

/// Unsaved texts over saved files. Results of disk accesses are cached until [`Overlay::refresh`], so that a keystroke does
/// not access the disk.
#[derive(Debug, Default)]
pub struct Overlay {
    open: Mutex<BTreeMap<PathBuf, String>>,
    read: Mutex<BTreeMap<PathBuf, Result<String, String>>>,
    places: Mutex<BTreeMap<(PathQuery, PathBuf), Option<PathBuf>>>,
}

/// A query about a path on the disk.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum PathQuery {
    /// The file or folder itself, with symbolic links resolved.
    Real,
    /// The folder of models of a lesson.
    Models,
    /// The root around a folder.
    Root,
}

impl Overlay {
    /// Sets the unsaved text of a file, whose path has its symbolic links resolved.
    pub fn put(&self, path: &Path, text: &str) {
        if locked(&self.open).insert(path.to_path_buf(), text.to_string()).is_none() {
            locked(&self.places).clear();
        }
    }

    /// Removes the unsaved text of a file.
    pub fn close(&self, path: &Path) {
        locked(&self.open).remove(path);
        self.refresh();
    }

    /// Clears the cache, because files may have changed.
    pub fn refresh(&self) {
        locked(&self.read).clear();
        locked(&self.places).clear();
    }

    /// The names of the unsaved files of a folder.
    pub fn names_in(&self, folder: &Path) -> Vec<String> {
        let open = locked(&self.open);
        let inside = open.keys().filter(|path| path.parent() == Some(folder));
        inside.filter_map(|path| Some(path.file_name()?.to_str()?.to_string())).collect()
    }

    fn text_in_memory(&self, real: &Path) -> Option<String> {
        locked(&self.open).get(real).cloned()
    }

    fn text(&self, path: &Path, most: u64, what: &str) -> Result<String, String> {
        let real =
            self.place(PathQuery::Real, path, || self.real(path)).unwrap_or_else(|| path.to_path_buf());
        if let Some(text) = self.text_in_memory(&real) {
            return Ok(text);
        }
        let cached = locked(&self.read).get(&real).cloned();
        cached.unwrap_or_else(|| {
            let text = read_text(path, most, what);
            locked(&self.read).insert(real, text.clone());
            text
        })
    }

    /// A file with an unsaved text exists, saved or not.
    fn real(&self, path: &Path) -> Option<PathBuf> {
        path.canonicalize().ok().or_else(|| {
            let place = path.parent()?.canonicalize().ok()?.join(path.file_name()?);
            locked(&self.open).contains_key(&place).then_some(place)
        })
    }

    fn place(
        &self,
        asked: PathQuery,
        path: &Path,
        find: impl FnOnce() -> Option<PathBuf>,
    ) -> Option<PathBuf> {
        let key = (asked, path.to_path_buf());
        let cached = locked(&self.places).get(&key).cloned();
        cached.unwrap_or_else(|| {
            let found = find();
            locked(&self.places).insert(key, found.clone());
            found
        })
    }
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A path with `.` and `..` resolved lexically, as for texts in memory.
fn plain(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir if matches!(plain.components().next_back(), Some(Component::Normal(_))) => {
                plain.pop();
            }
            part => plain.push(part),
        }
    }
    plain
}

impl Sources {
    /// Lessons and snapshots in memory, by their paths.
    pub fn given<P: AsRef<Path>, T: Into<String>>(texts: impl IntoIterator<Item = (P, T)>) -> Sources {
        let texts = texts.into_iter().map(|(path, text)| (plain(path.as_ref()), text.into()));
        Sources::Given(Arc::new(texts.collect()))
    }

    /// A text of at most `most` bytes; `what` describes it in messages.
    ///
    /// # Errors
    /// A message that states why it cannot be read.
    pub fn text(&self, path: &Path, most: u64, what: &str) -> Result<String, String> {
        match self {
            Sources::Given(texts) if texts.is_empty() => Err("only this lesson was given".into()),
            Sources::Given(texts) => match texts.get(&plain(path)) {
                Some(text) if text.len() as u64 > most => {
                    Err(format!("{what} can have at most {most} bytes"))
                }
                Some(text) => Ok(text.clone()),
                None => Err("that lesson was not given".into()),
            },
            Sources::Disk => read_text(path, most, what),
            Sources::Over(overlay) => overlay.text(path, most, what),
        }
    }

    /// Whether there are files besides the texts: then a link to a missing file is reported.
    pub(crate) fn has_files(&self) -> bool {
        !matches!(self, Sources::Given(_))
    }

    /// Whether a path exists, including a broken link.
    pub(crate) fn has(&self, path: &Path) -> bool {
        match self {
            Sources::Disk => std::fs::symlink_metadata(path).is_ok(),
            sources => sources.real(path).is_some(),
        }
    }

    /// The file or folder of a path with symbolic links resolved; `None` where there is none.
    pub fn real(&self, path: &Path) -> Option<PathBuf> {
        match self {
            Sources::Given(texts) => texts.contains_key(&plain(path)).then(|| plain(path)),
            Sources::Disk => path.canonicalize().ok(),
            Sources::Over(overlay) => overlay.place(PathQuery::Real, path, || overlay.real(path)),
        }
    }

    /// A path, or the target if it is a symbolic link.
    pub(crate) fn followed(&self, path: &Path) -> PathBuf {
        let is_link = || std::fs::symlink_metadata(path).is_ok_and(|meta| meta.is_symlink());
        let real = match self {
            Sources::Disk if is_link() => path.canonicalize().ok(),
            _ => None,
        };
        real.unwrap_or_else(|| path.to_path_buf())
    }

    /// The result of `find` for a path, which is cached in an editor.
    pub fn place(
        &self,
        asked: PathQuery,
        path: &Path,
        find: impl FnOnce() -> Option<PathBuf>,
    ) -> Option<PathBuf> {
        match self {
            Sources::Given(_) => None,
            Sources::Disk => find(),
            Sources::Over(overlay) => overlay.place(asked, path, find),
        }
    }

    /// An unsaved text, and the path of its file with symbolic links resolved.
    pub(crate) fn text_in_memory(&self, path: &Path) -> Option<(PathBuf, String)> {
        let Sources::Over(overlay) = self else { return None };
        let real = self.real(path)?;
        let text = overlay.text_in_memory(&real)?;
        Some((real, text))
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a panic is the report of a failed test
mod tests {
    use super::*;

    #[test]
    fn an_open_text_replaces_its_file_until_it_is_closed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().canonicalize().unwrap().join("a.md");
        std::fs::write(&path, "saved").unwrap();
        let overlay = Arc::new(Overlay::default());
        let sources = Sources::Over(overlay.clone());
        let text = || sources.text(&path, 100, "a lesson").unwrap();
        assert_eq!(text(), "saved");
        overlay.put(&path, "typed");
        assert_eq!(text(), "typed");
        overlay.close(&path);
        std::fs::write(&path, "saved again").unwrap();
        assert_eq!(text(), "saved again");
    }

    #[test]
    fn the_disk_is_read_once_until_a_change() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().canonicalize().unwrap().join("a.md");
        let overlay = Arc::new(Overlay::default());
        let sources = Sources::Over(overlay.clone());
        let seen = || (sources.has(&path), sources.text(&path, 100, "a lesson").ok());
        assert_eq!(seen(), (false, None));
        std::fs::write(&path, "written beside").unwrap();
        assert_eq!(seen(), (false, None));
        overlay.refresh();
        assert_eq!(seen(), (true, Some("written beside".into())));
        // A text of the editor exists before it is saved.
        let new = path.with_file_name("new.md");
        assert!(!sources.has(&new));
        overlay.put(&new, "typed");
        assert!(sources.has(&new));
    }

    #[test]
    fn texts_in_memory_are_found_by_their_plain_paths() {
        let sources = Sources::given([("week/labs.md", "labs")]);
        let text = |path: &str| sources.text(Path::new(path), 100, "a lesson");
        assert_eq!(text("week/../week/./labs.md").unwrap(), "labs");
        assert_eq!(text("labs.md").unwrap_err(), "that lesson was not given");
        let alone = Sources::default().text(Path::new("labs.md"), 100, "a lesson");
        assert_eq!(alone.unwrap_err(), "only this lesson was given");
        assert!(!sources.has(Path::new("/etc/passwd")));
    }
}
