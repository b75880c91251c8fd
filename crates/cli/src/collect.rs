//! Which files a command is about: those that were named, and the lessons of folders.

use super::stdio::complain;
use labspec::lint::{self, root_of};
use labspec::report::{printable_lines, printable_path};
use labspec::spec::{FileKind, kind_of};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The snapshots below these folders, or named themselves, whose lessons are gone, in a fixed order.
pub(super) fn lost_snapshots(paths: &[PathBuf]) -> Vec<PathBuf> {
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

/// A file to check, and whether it was named itself.
pub(super) type ListedFile = (PathBuf, bool);
/// What could not be read, and why.
pub(super) type UnreadFile = (PathBuf, String);

/// What stands for standard input.
pub(super) const STDIN: &str = "-";

/// What lies under the paths that a command was given.
#[derive(Default)]
pub(super) struct Collected {
    /// The files, in a fixed order.
    pub(super) files: Vec<ListedFile>,
    /// What could not be read, and why.
    pub(super) problems: Vec<UnreadFile>,
    /// What was left out, and why: links that lead out of the root.
    pub(super) left_out: Vec<UnreadFile>,
}

impl Collected {
    /// Names on standard error what was left out.
    pub(super) fn complain(&self) {
        for (path, why) in &self.left_out {
            complain(&printable_lines(&format!("labspec: {} is skipped: {why}\n", path.display())));
        }
    }
}

/// The files to check.
pub(super) fn collect(paths: &[PathBuf]) -> Collected {
    let mut all = Collected::default();
    let is_lesson = |path: &Path| matches!(kind_of(path), FileKind::Lesson | FileKind::Json);
    for path in paths {
        match std::fs::metadata(path) {
            // Standard input is read by whoever called.
            _ if path.as_os_str() == STDIN => {}
            Err(e) => all.problems.push((path.clone(), unreadable(path, &e))),
            Ok(meta) if meta.is_dir() => walk(path, &is_lesson, &mut all),
            Ok(_) => all.files.push((path.clone(), true)),
        }
    }
    all.files = once(all.files);
    all
}

fn unreadable(path: &Path, e: &std::io::Error) -> String {
    format!("cannot read {}: {e}", printable_path(path))
}

/// Each file once, however often and under whatever paths it was given: under the first of them.
fn once(files: Vec<ListedFile>) -> Vec<ListedFile> {
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

/// Deepest nesting of folders.
const MAX_DEPTH: usize = 32;

/// The files of a folder that are wanted, but for what is hidden, what `.gitignore` names, and the packages of node. A link to a file
/// below the root is followed. One that leads out of the root is left out, and a folder is looked through where it lies.
fn walk(folder: &Path, wanted: &dyn Fn(&Path) -> bool, all: &mut Collected) {
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
            follow(path, root, wanted, all);
        } else if kind.is_dir() && entry.depth() > MAX_DEPTH {
            let why = format!("{} is nested more than {MAX_DEPTH} folders deep", printable_path(path));
            all.problems.push((path.to_path_buf(), why));
        } else if kind.is_file() && wanted(path) {
            all.files.push((path.to_path_buf(), false));
        }
    }
}

/// Takes the file that a link leads to, where it lies below the root.
fn follow(link: &Path, root: &Path, wanted: &dyn Fn(&Path) -> bool, all: &mut Collected) {
    let real = match link.canonicalize() {
        Ok(real) => real,
        Err(e) => {
            if wanted(link) {
                all.problems.push((link.to_path_buf(), unreadable(link, &e)));
            }
            return;
        }
    };
    let is_file = real.is_file() && wanted(link);
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
            all.left_out.push((link.to_path_buf(), why));
        }
    }
}

fn printable_name(path: &Path) -> String {
    printable_path(path).to_string()
}
