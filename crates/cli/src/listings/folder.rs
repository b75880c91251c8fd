//! The temporary folder of a listing, and the files that listings share.

use super::NotRun;
use super::settings::ListingSettings;
use crate::digest;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

/// The maximum size of all shared files together, in bytes, and their maximum number.
const MAX_SHARED: u64 = 256 << 20;
const MAX_SHARED_FILES: usize = 10_000;
/// The maximum depth of shared folders.
const MAX_DEPTH: usize = 32;

/// The files that listings share.
#[derive(Default)]
pub(super) struct SharedFiles {
    /// Their paths in the folder of a run, and their contents.
    files: Vec<(PathBuf, Vec<u8>)>,
    /// Their paths.
    pub(super) sources: Vec<PathBuf>,
    /// The digest of all names and contents.
    pub(super) digest: String,
    size: u64,
}

/// Reads the files and folders of the settings.
pub(super) fn read_shared(settings: &ListingSettings) -> Result<SharedFiles, NotRun> {
    let mut shared = SharedFiles::default();
    for file in &settings.files {
        let path = settings.folder.join(file);
        let name = PathBuf::from(path.file_name().unwrap_or_default());
        shared.add(&path, &name, 0).map_err(|why| {
            (format!("{file}: {why}"), "correct `files` under [listings] in labspec.toml".to_string())
        })?;
    }
    let names = shared.files.iter().map(|(name, _)| name.as_os_str().as_encoded_bytes());
    let parts: Vec<&[u8]> =
        names.zip(&shared.files).flat_map(|(name, (_, bytes))| [name, bytes.as_slice()]).collect();
    shared.digest = digest::hex_of(&parts);
    Ok(shared)
}

impl SharedFiles {
    /// Adds a file, or all files of a folder in a fixed order. Folders behind links are skipped.
    fn add(&mut self, path: &Path, name: &Path, depth: usize) -> Result<(), String> {
        let meta = fs::metadata(path).map_err(|e| e.to_string())?;
        self.sources.push(path.to_path_buf());
        if meta.is_dir() {
            let is_link = path.symlink_metadata().is_ok_and(|meta| meta.is_symlink());
            if depth > MAX_DEPTH || (is_link && depth > 0) {
                return Ok(());
            }
            let entries = fs::read_dir(path).map_err(|e| e.to_string())?;
            let mut names: Vec<_> = entries.flatten().map(|entry| entry.file_name()).collect();
            names.sort();
            names.retain(|name| name != "__pycache__" && name != ".git");
            return names
                .iter()
                .try_for_each(|inner| self.add(&path.join(inner), &name.join(inner), depth + 1));
        }
        if !meta.is_file() {
            return Err("neither a file nor a folder".into());
        }
        self.size += meta.len();
        if self.size > MAX_SHARED || self.files.len() >= MAX_SHARED_FILES {
            return Err(format!("more than {MAX_SHARED_FILES} files or {} MiB", MAX_SHARED >> 20));
        }
        let bytes = fs::read(path).map_err(|e| format!("{}: {e}", name.display()))?;
        self.files.push((name.to_path_buf(), bytes));
        Ok(())
    }
}

/// A temporary folder with the folders `work`, `home` and `tmp`. It is removed at the end.
pub(super) struct RunFolder {
    root: PathBuf,
}

impl RunFolder {
    /// Makes a folder that only this user can read.
    pub(super) fn create() -> io::Result<RunFolder> {
        static COUNT: AtomicUsize = AtomicUsize::new(0);
        let base = std::env::temp_dir().canonicalize()?;
        loop {
            let number = COUNT.fetch_add(1, Ordering::Relaxed);
            let root = base.join(format!("labspec-listing-{}-{number}", std::process::id()));
            // An existing folder belongs to somebody else.
            match private_folder(&root) {
                Err(e) if e.kind() == io::ErrorKind::AlreadyExists && number < 100_000 => {}
                Err(e) => return Err(e),
                Ok(()) => {
                    let folder = RunFolder { root };
                    for inner in [folder.work(), folder.home(), folder.temporary()] {
                        fs::create_dir(inner)?;
                    }
                    return Ok(folder);
                }
            }
        }
    }

    /// The working folder.
    pub(super) fn work(&self) -> PathBuf {
        self.root.join("work")
    }

    pub(super) fn home(&self) -> PathBuf {
        self.root.join("home")
    }

    pub(super) fn temporary(&self) -> PathBuf {
        self.root.join("tmp")
    }

    /// Writes the shared files and the listing.
    pub(super) fn write(&self, shared: &SharedFiles, path: &str, code: &str) -> io::Result<()> {
        let files = shared.files.iter().map(|(name, bytes)| (name.as_path(), bytes.as_slice()));
        for (name, bytes) in files.chain([(Path::new(path), code.as_bytes())]) {
            let file = self.work().join(name);
            if let Some(folder) = file.parent() {
                fs::create_dir_all(folder)?;
            }
            fs::write(file, bytes)?;
        }
        Ok(())
    }
}

fn private_folder(path: &Path) -> io::Result<()> {
    #[cfg_attr(not(unix), expect(unused_mut, reason = "there are no modes"))]
    let mut builder = fs::DirBuilder::new();
    #[cfg(unix)]
    std::os::unix::fs::DirBuilderExt::mode(&mut builder, 0o700);
    builder.create(path)
}

impl Drop for RunFolder {
    fn drop(&mut self) {
        if fs::remove_dir_all(&self.root).is_err() {
            // The listing may have taken the permissions of a folder away.
            allow_removal(&self.root, 0);
            let _ = fs::remove_dir_all(&self.root);
        }
    }
}

/// Gives the user all permissions for a folder and the folders in it. Links are not followed.
fn allow_removal(folder: &Path, depth: usize) {
    if depth > 200 || !folder.symlink_metadata().is_ok_and(|meta| meta.is_dir()) {
        return;
    }
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        let _ = fs::set_permissions(folder, fs::Permissions::from_mode(0o700));
    }
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        allow_removal(&entry.path(), depth + 1);
    }
}
