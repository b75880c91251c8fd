//! A file of a crate or of the tests has at most 500 lines, so that one idea is one file.

#![allow(clippy::unwrap_used)]

use crate::support::workspace;
use std::path::PathBuf;

const MOST_LINES: usize = 500;
/// The table of all fields, which is one list.
const TABLES: [&str; 1] = ["crates/engine/src/model/fields.rs"];

#[test]
fn files_of_crates_are_short() {
    let workspace = workspace();
    let mut folders: Vec<PathBuf> = ["crates", "tests"].map(|folder| workspace.join(folder)).to_vec();
    let (mut files, mut long) = (0, Vec::new());
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() && path.file_name().is_some_and(|name| name != "target") {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| ending == "rs") {
                files += 1;
                let lines = std::fs::read_to_string(&path).unwrap().lines().count();
                let name = path.strip_prefix(&workspace).unwrap().to_string_lossy().replace('\\', "/");
                if lines > MOST_LINES && !TABLES.contains(&name.as_str()) {
                    long.push(format!("{name}: {lines} lines"));
                }
            }
        }
    }
    assert!(files > 1000, "{files}");
    assert!(long.is_empty(), "split these files by their ideas: {long:?}");
}
