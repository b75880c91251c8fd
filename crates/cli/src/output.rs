//! Writing of files. A file is written under a temporary name and renamed, so that a full disk or a crash loses nothing. An
//! output never overwrites an input, and two outputs never use the same file.

use super::common::Failure;
use super::output_kind::OutputKind;
use labspec::report::printable_path;
use std::collections::BTreeSet;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Writes a file atomically. An existing file is replaced only if it is of the same kind.
pub(super) fn write_file(path: &Path, kind: OutputKind<'_>, text: &str) -> Result<(), Failure> {
    write_with(path, kind, |out| out.write_all(text.as_bytes()))
}

/// Removes a file of this kind.
pub(super) fn remove_file(path: &Path, kind: OutputKind<'_>) -> Result<(), Failure> {
    let cannot = |e: io::Error| format!("cannot remove {}: {e}", printable_path(path));
    let old = fs::symlink_metadata(path).map_err(cannot)?;
    if let Some(why) = kind.refusal(path, &old) {
        return Err(cannot(io::Error::new(io::ErrorKind::InvalidInput, why)));
    }
    fs::remove_file(path).map_err(cannot)
}

/// Writes a file of a site, with its folders. The folder of the site was empty or had an earlier one. A link is replaced, never
/// followed.
pub(super) fn write_site_file(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let write = || -> io::Result<()> {
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder)?;
        }
        if path.symlink_metadata().is_ok_and(|meta| meta.is_symlink()) {
            fs::remove_file(path)?;
        }
        fs::write(path, bytes)
    };
    write().map_err(|e| format!("cannot write {}: {e}", printable_path(path)))
}

/// Removes a file of an earlier site, if it is still there.
pub(super) fn remove_site_file(path: &Path) {
    let _ = fs::remove_file(path);
}

/// Writes a picture as PNG, with two pixels per unit of the SVG.
pub(super) fn write_png(path: &Path, svg: &str) -> Result<(), Failure> {
    let bytes = pixels(svg).map_err(|e| format!("cannot draw {}: {e}", printable_path(path)))?;
    write_with(path, OutputKind::Picture, |out| out.write_all(&bytes))
}

#[cfg(feature = "png")]
fn pixels(svg: &str) -> Result<Vec<u8>, String> {
    labspec_plot::png(svg, 2.0)
}

#[cfg(not(feature = "png"))]
fn pixels(_: &str) -> Result<Vec<u8>, String> {
    Err("this program was built without the feature `png`; --svg draws the same picture".into())
}

/// As [`write_file`], with a function that writes the content.
pub(super) fn write_with(
    path: &Path,
    kind: OutputKind<'_>,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), Failure> {
    replace(path, kind, write)
        .map_err(|e| format!("cannot write {}: {e}; the old file is unchanged", printable_path(path)))
}

fn replace(
    path: &Path,
    kind: OutputKind<'_>,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    let place = place(path)?;
    let old = writable(&place)?;
    if let Some(why) = old.as_ref().and_then(|old| kind.refusal(&place, old)) {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, why));
    }
    if let Some(folder) = place.parent() {
        clear_abandoned(folder, is_temporary);
    }
    let (mut temporary, file) = Temporary::create_temporary(&place)?;
    if let Some(old) = &old {
        keep_owner(&temporary.path, old);
        fs::set_permissions(&temporary.path, old.permissions())?;
    }
    let mut out = BufWriter::with_capacity(1 << 16, file);
    let done = write(&mut out).and_then(|()| out.flush());
    // Dropping the buffer would write again to a disk that has just failed.
    let (file, _) = out.into_parts();
    done?;
    file.sync_all()?;
    drop(file);
    fs::rename(&temporary.path, &place)?;
    temporary.renamed = true;
    // The folder contains the new name, so it is synced as well; not every system supports this.
    if let Some(folder) = place.parent() {
        let _ = File::open(folder).and_then(|f| f.sync_all());
    }
    Ok(())
}

/// The age in seconds after which an unchanged temporary file counts as abandoned. A younger one may belong to another run.
const ABANDONED_AFTER: u64 = 600;

/// Whether a file has the name of a [`Temporary`]: `.labspec-12-0.tmp`.
fn is_temporary(name: &str) -> bool {
    let number = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    let inside = name.strip_prefix(".labspec-").and_then(|rest| rest.strip_suffix(".tmp"));
    inside.and_then(|rest| rest.split_once('-')).is_some_and(|(a, b)| number(a) && number(b))
}

/// Removes the temporary files of killed runs from a folder: files with such a name whose process does not exist any more, or,
/// if that is unknown, that have not been written for ten minutes. Each folder is searched once.
pub(super) fn clear_abandoned(folder: &Path, is_temporary: fn(&str) -> bool) {
    static ABANDONED_FILES: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());
    if !ABANDONED_FILES.lock().is_ok_and(|mut seen| seen.insert(folder.to_path_buf())) {
        return;
    }
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let Some(name) = name.to_str().filter(|name| is_temporary(name)) else { continue };
        let process = name.trim_start_matches(".labspec-").split('-').next().and_then(|n| n.parse().ok());
        let Ok(meta) = entry.metadata() else { continue };
        let age = meta.modified().ok().and_then(|time| time.elapsed().ok()).map_or(0, |age| age.as_secs());
        let gone = process.is_some_and(has_ended);
        if meta.is_file() && process != Some(std::process::id()) && (gone || age >= ABANDONED_AFTER) {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Whether the system states that no process with this id is running.
fn has_ended(process: u32) -> bool {
    Path::new("/proc/self").exists() && !Path::new(&format!("/proc/{process}")).exists()
}

/// A temporary file, which is removed when dropped unless it was renamed.
struct Temporary {
    path: PathBuf,
    renamed: bool,
}

impl Temporary {
    fn create_temporary(place: &Path) -> io::Result<(Temporary, File)> {
        static COUNT: AtomicUsize = AtomicUsize::new(0);
        let mut last = None;
        for _ in 0..100 {
            let n = COUNT.fetch_add(1, Ordering::Relaxed);
            let path = place.with_file_name(format!(".labspec-{}-{n}.tmp", std::process::id()));
            match OpenOptions::new().write(true).create_new(true).open(&path) {
                Ok(file) => return Ok((Temporary { path, renamed: false }, file)),
                Err(e) if e.kind() == io::ErrorKind::AlreadyExists => last = Some(e),
                Err(e) => return Err(e),
            }
        }
        Err(last.unwrap_or_else(|| io::ErrorKind::AlreadyExists.into()))
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        if !self.renamed {
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// Keeps the owner of a file that another user replaces, such as an administrator, if the system allows it.
fn keep_owner(path: &Path, old: &fs::Metadata) {
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        if fs::metadata(path).is_ok_and(|new| (new.uid(), new.gid()) != (old.uid(), old.gid())) {
            let _ = std::os::unix::fs::chown(path, Some(old.uid()), Some(old.gid()));
        }
    }
    #[cfg(not(unix))]
    let _ = (path, old);
}

/// The target of a path. Links are resolved so that they remain links, including links to files that do not exist yet.
fn place(path: &Path) -> io::Result<PathBuf> {
    let mut path = path.to_path_buf();
    for _ in 0..40 {
        match fs::symlink_metadata(&path) {
            Ok(meta) if meta.is_symlink() => {
                let to = fs::read_link(&path)?;
                path = path.parent().unwrap_or(Path::new("")).join(to);
            }
            _ => {
                let name = path.file_name().ok_or_else(|| {
                    io::Error::new(io::ErrorKind::InvalidInput, "it is not the name of a file")
                })?;
                let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
                return Ok(folder.canonicalize()?.join(name));
            }
        }
    }
    Err(io::Error::new(io::ErrorKind::InvalidInput, "its links form a circle"))
}

/// The metadata of the existing file, if it can be written. A pipe or a device is never opened, because that may block.
fn writable(place: &Path) -> io::Result<Option<fs::Metadata>> {
    let meta = match fs::metadata(place) {
        Ok(meta) => meta,
        Err(e) if e.kind() == io::ErrorKind::NotFound => return Ok(None),
        Err(e) => return Err(e),
    };
    if !meta.is_file() {
        let what = if meta.is_dir() { "it is a folder" } else { "it is a device or a pipe, not a file" };
        return Err(io::Error::new(io::ErrorKind::InvalidInput, what));
    }
    // Renaming would replace even a read-only file.
    OpenOptions::new().write(true).open(place)?;
    Ok(Some(meta))
}

/// The identity of a file: its path and, if it exists, its number in the file system.
#[derive(Debug, PartialEq, Eq)]
struct FileIdentity {
    place: PathBuf,
    number: Option<(u64, u64)>,
}

impl FileIdentity {
    fn read(path: &Path) -> io::Result<FileIdentity> {
        let place = place(path)?;
        let number = fs::metadata(&place).ok().and_then(|m| number(&m));
        Ok(FileIdentity { place, number })
    }

    fn is(&self, other: &FileIdentity) -> bool {
        self.place == other.place || (self.number.is_some() && self.number == other.number)
    }
}

fn number(meta: &fs::Metadata) -> Option<(u64, u64)> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        Some((meta.dev(), meta.ino()))
    }
    #[cfg(not(unix))]
    {
        let _ = meta;
        None
    }
}

/// A requested output: its kind and its file.
pub(super) struct PlannedOutput {
    pub(super) kind: OutputKind<'static>,
    pub(super) path: PathBuf,
}

/// The outputs that were requested.
pub(super) fn requested_outputs(outputs: &[(OutputKind<'static>, &Option<PathBuf>)]) -> Vec<PlannedOutput> {
    let asked = outputs
        .iter()
        .filter_map(|(kind, path)| Some(PlannedOutput { kind: *kind, path: path.as_ref()?.clone() }));
    asked.collect()
}

/// Checks all outputs of a command before it begins.
///
/// # Errors
/// An output would overwrite an input or another output, or cannot be written.
pub(super) fn check_outputs_writable(read: &[PathBuf], outputs: &[PlannedOutput]) -> Result<(), Failure> {
    let inputs: Vec<FileIdentity> = read.iter().filter_map(|p| FileIdentity::read(p).ok()).collect();
    let mut written: Vec<(FileIdentity, String)> = Vec::new();
    // Standard output may be redirected to a file.
    #[cfg(unix)]
    if let Some(meta) = fs::metadata("/dev/stdout").ok().filter(fs::Metadata::is_file) {
        written.push((FileIdentity { place: PathBuf::new(), number: number(&meta) }, "the output".into()));
    }
    for PlannedOutput { kind, path } in outputs {
        let named = format!("{} {}", kind.option(), printable_path(path));
        let cannot = |e: io::Error| format!("cannot write {named}: {e}");
        let identity = FileIdentity::read(path).map_err(cannot)?;
        let old = writable(&identity.place).map_err(cannot)?;
        let is_read = old.is_some() && kind.is_input(&identity.place);
        if is_read || inputs.iter().any(|input| input.is(&identity)) {
            return Err(format!(
                "{named} would overwrite a lesson or a model, so nothing was written; name another file"
            ));
        }
        if old.as_ref().is_some_and(|old| kind.refusal(&identity.place, old).is_some()) {
            return Err(format!(
                "{named} would overwrite a file that labspec did not write with this option, so nothing was written; name another file, or remove that one first"
            ));
        }
        if let Some((_, other)) = written.iter().find(|(t, _)| t.is(&identity)) {
            return Err(format!(
                "{named} and {other} are the same file, so nothing was written; name different ones"
            ));
        }
        written.push((identity, named));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A run that was killed between writing and renaming leaves a temporary file, which the next run removes.
    #[test]
    fn temporary_files_of_a_killed_run_are_removed() {
        let folder = tempfile::tempdir().unwrap();
        let path_of = |name: &str| folder.path().join(name);
        // The first name has a process id that does not exist. The second belongs to this process, which may still write it.
        // The others are not names of temporary files.
        let temporary = format!(".labspec-{}-77.tmp", std::process::id());
        let remaining = [
            temporary.as_str(),
            ".labspec-notes.tmp",
            ".labspec-1-x.tmp",
            "labspec-4294967295-0.tmp",
            "a.tmp",
        ];
        for name in remaining.into_iter().chain([".labspec-4294967295-0.tmp"]) {
            fs::write(path_of(name), "half").unwrap();
        }
        write_file(&path_of("out.csv"), OutputKind::Table, "whole").unwrap();
        assert_eq!(fs::read_to_string(path_of("out.csv")).unwrap(), "whole");
        assert!(!path_of(".labspec-4294967295-0.tmp").exists() || !Path::new("/proc/self").exists());
        for name in remaining {
            assert!(path_of(name).exists(), "{name}");
        }
    }
}
