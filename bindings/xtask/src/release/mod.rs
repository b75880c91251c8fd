//! A release: everything that is published, in one folder, beside a file with the checksums of all of it.
//!
//! Each part is a row of [`PARTS`]. A part whose tool is missing fails and says what to install; what is built for another machine is
//! skipped with a reason. Archives hold no times and no owners.

mod archive;
mod components;
mod library;
mod packages;
mod platform;
mod program;
mod wheel;

use std::fs;
use std::path::{Path, PathBuf};

/// What the parts of a release need.
pub(crate) struct Release {
    /// The repository.
    root: PathBuf,
    /// Where cargo builds.
    target: PathBuf,
    /// Where the files of the release are written.
    folder: PathBuf,
    /// Returns the folder of the scripts and styles of pages, which are built if they are missing, after the modules.
    scripts: Scripts,
    /// The version of all packages.
    version: String,
    /// Whether the programs are built fast and without optimization, to try the release: `LABSPEC_PROFILE=quick`.
    quick: bool,
}

/// Builds what is missing of the scripts and styles of pages, and returns their folder.
type Scripts = fn() -> Result<PathBuf, String>;

/// A part writes its files, and returns their paths.
type Part = fn(&Release) -> Result<Vec<PathBuf>, String>;

/// The parts of a release: name, and what writes it.
const PARTS: [(&str, Part); 7] = [
    ("program", program::archives),
    ("c", library::archives),
    ("crates", packages::crates),
    ("npm", packages::npm_tarballs),
    ("wheel", wheel::wheels),
    ("editor", packages::editor),
    ("components", components::lists),
];

/// The file with the checksums.
const SUMS: &str = "SHA256SUMS";

/// Writes a release, or the parts of it that are named, into a folder.
pub(crate) fn release(
    folder: Option<PathBuf>,
    parts: &[String],
    scripts: Scripts,
) -> Result<PathBuf, String> {
    if let Some(unknown) = parts.iter().find(|part| PARTS.iter().all(|(name, _)| name != part)) {
        let names: Vec<_> = PARTS.iter().map(|(name, _)| *name).collect();
        return Err(format!("`{unknown}` is no part of a release; the parts are {}", names.join(", ")));
    }
    let root = crate::page::root();
    let root = root.canonicalize().map_err(|e| format!("{}: {e}", root.display()))?;
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), PathBuf::from);
    let folder = folder.unwrap_or_else(|| target.join("release-archives"));
    fs::create_dir_all(&folder).map_err(|e| failed(&folder, &e))?;
    let version = version(&root)?;
    let quick = std::env::var("LABSPEC_PROFILE").is_ok_and(|profile| profile == "quick");
    let release = Release { root, target, folder, scripts, version, quick };
    let mut files = Vec::new();
    for (name, write) in PARTS {
        if parts.is_empty() || parts.iter().any(|part| part == name) {
            eprintln!("xtask: release: {name}");
            files.extend(write(&release).map_err(|why| format!("{name}: {why}"))?);
        }
    }
    let sums = sums(&files)?;
    write(&release.folder.join(SUMS), sums.as_bytes())?;
    Ok(release.folder)
}

/// The version of the workspace.
fn version(root: &Path) -> Result<String, String> {
    let file = root.join("Cargo.toml");
    let text = fs::read_to_string(&file).map_err(|e| failed(&file, &e))?;
    let version = text.lines().find_map(|line| line.strip_prefix("version = \"")?.strip_suffix('"'));
    version.map(String::from).ok_or_else(|| format!("{} has no version", file.display()))
}

/// A line for each file, as `sha256sum --check` reads them.
fn sums(files: &[PathBuf]) -> Result<String, String> {
    let mut lines = Vec::new();
    for file in files {
        let name = file.file_name().and_then(|name| name.to_str()).ok_or("a file has no name")?;
        lines.push(format!("{}  {name}\n", archive::sum(&read(file)?)));
    }
    lines.sort_by(|a, b| {
        a.split_once("  ").map(|(_, name)| name).cmp(&b.split_once("  ").map(|(_, name)| name))
    });
    Ok(lines.concat())
}

fn failed(path: &Path, why: &std::io::Error) -> String {
    format!("{}: {why}", path.display())
}

fn read(path: &Path) -> Result<Vec<u8>, String> {
    fs::read(path).map_err(|e| failed(path, &e))
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), String> {
    fs::write(path, bytes).map_err(|e| failed(path, &e))
}

/// Copies a file into a folder, under a name if one is given.
fn copied(file: &Path, folder: &Path, name: Option<String>) -> Result<PathBuf, String> {
    let name = name.map_or_else(|| file.file_name().unwrap_or_default().to_owned(), Into::into);
    let to = folder.join(name);
    fs::copy(file, &to).map_err(|e| failed(file, &e))?;
    Ok(to)
}

/// Makes an empty folder.
fn emptied(folder: &Path) -> Result<(), String> {
    if folder.exists() {
        fs::remove_dir_all(folder).map_err(|e| failed(folder, &e))?;
    }
    fs::create_dir_all(folder).map_err(|e| failed(folder, &e))
}

/// The files of a folder, in the order of their names.
fn files_of(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let entries =
        fs::read_dir(folder).map_err(|e| failed(folder, &e))?.map(|entry| entry.map(|entry| entry.path()));
    let mut all = entries.collect::<Result<Vec<_>, _>>().map_err(|e| failed(folder, &e))?;
    all.retain(|path| path.is_file());
    all.sort();
    Ok(all)
}
