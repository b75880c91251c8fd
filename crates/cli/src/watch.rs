//! Waiting for files to change, by looking at their sizes and times.

use super::collect::collect;
use super::common::{Failure, Outcome, interrupted};
use super::policy;
use super::stdio::complain;
use labspec::lint;
use labspec::report::printable_lines;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

/// How often files are looked at.
const PAUSE: Duration = Duration::from_millis(300);

/// What a file was when it was looked at: its size and time; `None` while there is none.
type Stamp = Option<(u64, SystemTime)>;

/// Checks, waits until something has changed, and checks again, until Ctrl-C. `check` says what came of it, and which files
/// it depends on besides those that were named.
pub(super) fn watch(
    paths: &[PathBuf],
    settings: &[&Path],
    mut check: impl FnMut() -> Result<(Result<Outcome, Failure>, BTreeSet<PathBuf>), Failure>,
) -> Result<Outcome, Failure> {
    let mut also: BTreeSet<PathBuf> = settings.iter().map(|path| path.to_path_buf()).collect();
    loop {
        // Before the check: what changes while it goes on is checked again.
        let mut before = stamps(paths, &also);
        let outcome = check().and_then(|(outcome, read)| {
            // What this check was the first to read.
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
            complain(&format!("labspec: {}\n", printable_lines(message)));
        }
        complain("labspec: waiting for changes; Ctrl-C ends\n");
        while stamps(paths, &also) == before {
            std::thread::sleep(PAUSE);
            if interrupted() {
                return outcome;
            }
        }
    }
}

/// What counts for a lesson besides its own text: its snapshot, and the settings of the folders around it, which may not be there
/// yet.
fn beside(path: &Path) -> Vec<PathBuf> {
    let real = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
    let settings = real.ancestors().skip(1).map(|folder| folder.join(policy::FILE));
    settings.chain([lint::snapshot_path(path)]).collect()
}

/// The files that were named or lie in folders that were named, and others.
fn stamps(paths: &[PathBuf], also: &BTreeSet<PathBuf>) -> BTreeMap<PathBuf, Stamp> {
    let found = collect(paths).files.into_iter().map(|(path, _)| path);
    found
        .flat_map(|path| beside(&path).into_iter().chain([path]))
        .chain(paths.iter().filter(|p| !p.is_dir()).cloned())
        .chain(also.iter().cloned())
        .map(|p| (p.clone(), stamp(&p)))
        .collect()
}

fn stamp(path: &Path) -> Stamp {
    let meta = std::fs::metadata(path).ok()?;
    Some((meta.len(), meta.modified().ok()?))
}
