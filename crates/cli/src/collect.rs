//! The files of a command: those named by the user, and the lessons in folders.

use super::stdio::print_error;
use labspec::lint::{self, root_of};
use labspec::report::{printable_lines, printable_path};
use labspec::spec::{FileKind, kind_of};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The snapshots whose lessons no longer exist, below these folders or named directly, in a fixed order.
pub(super) fn orphaned_snapshots(paths: &[PathBuf]) -> Vec<PathBuf> {
    let is_lost = |path: &Path| {
        let name = path.file_name().and_then(|name| name.to_str());
        let lesson =
            name.and_then(|name| name.strip_suffix(lint::SNAPSHOT)).map(|name| path.with_file_name(name));
        lesson
            .is_some_and(|path| matches!(kind_of(&path), FileKind::Lesson | FileKind::Json) && !path.exists())
    };
    let mut all = Collected::default();
    for path in paths {
        if path.is_dir() {
            walk(path, &is_lost, &mut all);
        } else if path.exists() && is_lost(path) {
            all.files.push((path.clone(), true));
        }
    }
    all.files.into_iter().map(|(path, _)| path).collect()
}

/// A file to check, and whether the user named it directly.
pub(super) type ListedFile = (PathBuf, bool);
/// A path that could not be read, and the reason.
pub(super) type UnreadFile = (PathBuf, String);

/// The path that denotes standard input.
pub(super) const STDIN: &str = "-";

/// The files under the paths of a command.
#[derive(Default)]
pub(super) struct Collected {
    /// The files in a fixed order.
    pub(super) files: Vec<ListedFile>,
    /// Paths that could not be read, with the reasons.
    pub(super) problems: Vec<UnreadFile>,
    /// Paths that were skipped, with the reasons: links that lead out of the root.
    pub(super) skipped: Vec<UnreadFile>,
}

impl Collected {
    /// Prints the skipped paths on standard error.
    pub(super) fn print_skipped(&self) {
        for (path, why) in &self.skipped {
            print_error(&printable_lines(&format!("labspec: {} is skipped: {why}\n", path.display())));
        }
    }
}

/// Returns the files to check.
pub(super) fn collect(paths: &[PathBuf]) -> Collected {
    let mut all = Collected::default();
    let is_lesson = |path: &Path| matches!(kind_of(path), FileKind::Lesson | FileKind::Json);
    for path in paths {
        match std::fs::metadata(path) {
            // The caller reads standard input.
            _ if path.as_os_str() == STDIN => {}
            Err(e) => all.problems.push((path.clone(), unreadable(path, &e))),
            Ok(meta) if meta.is_dir() => walk(path, &is_lesson, &mut all),
            Ok(_) => all.files.push((path.clone(), true)),
        }
    }
    all.files = without_duplicates(all.files);
    all
}

fn unreadable(path: &Path, e: &std::io::Error) -> String {
    format!("cannot read {}: {e}", printable_path(path))
}

/// Removes duplicates of the same file; the first path is used.
fn without_duplicates(files: Vec<ListedFile>) -> Vec<ListedFile> {
    let mut places: BTreeMap<PathBuf, usize> = BTreeMap::new();
    let mut all: Vec<ListedFile> = Vec::new();
    for (path, named) in files {
        let real = path.canonicalize().unwrap_or_else(|_| path.clone());
        let place = *places.entry(real).or_insert(all.len());
        match all.get_mut(place) {
            Some((_, before)) => *before |= named,
            None => all.push((path, named)),
        }
    }
    all
}

/// The maximum nesting of folders.
const MAX_DEPTH: usize = 32;

/// Collects the selected files of a folder, except hidden files, files listed in `.gitignore`, and `node_modules`. A link to a
/// file below the root is followed. A link that leads out of the root is skipped. Links to folders are not followed, because
/// the folder itself is visited.
fn walk(folder: &Path, is_selected: &dyn Fn(&Path) -> bool, all: &mut Collected) {
    let entries = ignore::WalkBuilder::new(folder)
        .follow_links(false)
        .require_git(false)
        .git_global(false)
        .max_depth(Some(MAX_DEPTH + 1))
        .filter_entry(|e| e.file_name() != "node_modules")
        .sort_by_file_path(Path::cmp)
        .build();
    let mut root = None;
    for entry in entries {
        let entry = match entry {
            Ok(entry) => entry,
            Err(e) => {
                all.problems.push((folder.to_path_buf(), format!("cannot read {e}")));
                continue;
            }
        };
        let path = entry.path();
        let Some(kind) = entry.file_type() else { continue };
        if kind.is_symlink() && entry.depth() > 0 {
            let root = root.get_or_insert_with(|| root_of(folder, &[]));
            follow(path, root, is_selected, all);
        } else if kind.is_dir() && entry.depth() > MAX_DEPTH {
            let why = format!("{} is nested more than {MAX_DEPTH} folders deep", printable_path(path));
            all.problems.push((path.to_path_buf(), why));
        } else if kind.is_file() && is_selected(path) {
            all.files.push((path.to_path_buf(), false));
        }
    }
}

/// Adds the target of a link if it is below the root.
fn follow(link: &Path, root: &Path, is_selected: &dyn Fn(&Path) -> bool, all: &mut Collected) {
    let real = match link.canonicalize() {
        Ok(real) => real,
        Err(e) => {
            if is_selected(link) {
                all.problems.push((link.to_path_buf(), unreadable(link, &e)));
            }
            return;
        }
    };
    let is_file = real.is_file() && is_selected(link);
    if !is_file && !real.is_dir() {
        return;
    }
    match real.starts_with(root) {
        true if is_file => all.files.push((link.to_path_buf(), false)),
        true => {}
        false => {
            let why = format!(
                "it is a link that leads outside {}; name {} itself",
                printable_name(root),
                printable_name(&real)
            );
            all.skipped.push((link.to_path_buf(), why));
        }
    }
}

fn printable_name(path: &Path) -> String {
    printable_path(path).to_string()
}
