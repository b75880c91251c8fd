//! Detects changes of files by their sizes and times.

use super::collect::collect;
use super::common::{CommandOutcome, Failure, interrupted};
use super::policy;
use super::stdio::print_error;
use labspec::lint;
use labspec::report::printable_lines;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

/// The interval between two inspections of the files.
const PAUSE: Duration = Duration::from_millis(300);

/// The size and the time of a file, or `None` if it does not exist.
pub(super) type Stamp = Option<(u64, SystemTime)>;

/// Checks, waits until a file changes, and checks again, until Ctrl-C. `check` returns its outcome and the files on which it
/// depends, in addition to those that were named.
pub(super) fn watch(
    paths: &[PathBuf],
    settings: &[&Path],
    mut check: impl FnMut() -> Result<(Result<CommandOutcome, Failure>, BTreeSet<PathBuf>), Failure>,
) -> Result<CommandOutcome, Failure> {
    let mut also: BTreeSet<PathBuf> = settings.iter().map(|path| path.to_path_buf()).collect();
    loop {
        // Recorded before the check, so that a change during the check triggers another one.
        let mut before = stamps(paths, &also);
        let outcome = check().and_then(|(outcome, read)| {
            // The files that this check was the first to read.
            let new: BTreeSet<PathBuf> = read.difference(&also).cloned().collect();
            for path in new {
                before.entry(path.clone()).or_insert_with(|| stamp(&path));
                also.insert(path);
            }
            outcome
        });
        if interrupted() {
            return outcome;
        }
        if let Err(message) = &outcome {
            print_error(&format!("labspec: {}\n", printable_lines(message)));
        }
        print_error("labspec: waiting for changes; Ctrl-C ends\n");
        while stamps(paths, &also) == before {
            std::thread::sleep(PAUSE);
            if interrupted() {
                return outcome;
            }
        }
    }
}

/// The other files that affect a lesson: its snapshot, and the settings of the enclosing folders, which may not exist yet.
fn related_files(path: &Path) -> Vec<PathBuf> {
    let real = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
    let settings = real.ancestors().skip(1).map(|folder| folder.join(policy::FILE));
    settings.chain([lint::snapshot_path(path)]).collect()
}

/// The state of the named files, of the files in named folders, and of further files.
pub(super) fn stamps(paths: &[PathBuf], also: &BTreeSet<PathBuf>) -> BTreeMap<PathBuf, Stamp> {
    let found = collect(paths).files.into_iter().map(|(path, _)| path);
    found
        .flat_map(|path| related_files(&path).into_iter().chain([path]))
        .chain(paths.iter().filter(|p| !p.is_dir()).cloned())
        .chain(also.iter().cloned())
        .map(|p| (p.clone(), stamp(&p)))
        .collect()
}

fn stamp(path: &Path) -> Stamp {
    let meta = std::fs::metadata(path).ok()?;
    Some((meta.len(), meta.modified().ok()?))
}
