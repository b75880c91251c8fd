//! Where the neighbours of a lesson are read from: its snapshot, the lessons whose labs it names, the lessons that it links to.

use crate::source::read_text;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::SystemTime;

/// Where texts come from.
#[derive(Clone, Debug, Default)]
pub enum Sources {
    /// Files, as they are saved.
    #[default]
    Disk,
    /// Texts that an editor holds, and files where it holds none.
    Over(Arc<Overlay>),
}

/// Texts that are not saved yet over files, which are read again only when they have changed.
#[derive(Debug, Default)]
pub struct Overlay {
    open: Mutex<BTreeMap<PathBuf, String>>,
    read: Mutex<BTreeMap<PathBuf, Cached>>,
}

/// A file as it was read: what the system said of it then, and its text.
#[derive(Debug)]
struct Cached {
    size: u64,
    changed: SystemTime,
    text: Result<String, String>,
}

impl Overlay {
    /// The text that the editor holds of a file, links resolved.
    pub fn put(&self, path: &Path, text: &str) {
        locked(&self.open).insert(path.to_path_buf(), text.to_string());
    }

    /// The editor holds no text of it any more.
    pub fn close(&self, path: &Path) {
        locked(&self.open).remove(path);
    }

    fn text(&self, path: &Path, most: u64, what: &str) -> Result<String, String> {
        let real = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
        if let Some(text) = locked(&self.open).get(&real) {
            return Ok(text.clone());
        }
        let stamp = std::fs::metadata(&real).and_then(|meta| Ok((meta.len(), meta.modified()?)));
        let Ok((size, changed)) = stamp else { return read_text(path, most, what) };
        let mut read = locked(&self.read);
        if let Some(known) = read.get(&real).filter(|k| k.size == size && k.changed == changed) {
            return known.text.clone();
        }
        let text = read_text(path, most, what);
        read.insert(real, Cached { size, changed, text: text.clone() });
        text
    }
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Sources {
    /// A text of at most so many bytes; `what` says what it is.
    ///
    /// # Errors
    /// A sentence that says why it cannot be read.
    pub(super) fn text(&self, path: &Path, most: u64, what: &str) -> Result<String, String> {
        match self {
            Sources::Disk => read_text(path, most, what),
            Sources::Over(overlay) => overlay.text(path, most, what),
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn an_open_text_stands_for_its_file_until_it_is_closed() {
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
}
