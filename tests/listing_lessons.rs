//! The lessons in `tests/listings`: their outputs are right, and every changed digit of them is found.
//!
//! A copy of a lesson has one changed digit. All copies are checked in one run of the program, which runs each distinct listing
//! once: a displayed output is not part of the key of a result. All 900 copies take 4 s.

#![allow(clippy::unwrap_used, clippy::panic)]

use crate::needs::{is_available, needs};
use crate::program::program;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

fn source() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/listings")
}

/// The lessons: name and text.
fn lessons() -> Vec<(String, String)> {
    let mut all = Vec::new();
    for entry in std::fs::read_dir(source()).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|ending| ending == "md") {
            let name = path.file_stem().unwrap().to_str().unwrap().to_string();
            all.push((name, std::fs::read_to_string(&path).unwrap()));
        }
    }
    all.sort();
    all
}

/// A folder with the settings and the shared files of the lessons, without the lessons. Where the network cannot be switched off,
/// listings run with it.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let mut settings = std::fs::read_to_string(source().join("labspec.toml")).unwrap();
    if !is_available("unshare") {
        settings.push_str("network = true\n");
    }
    std::fs::write(folder.path().join("labspec.toml"), settings).unwrap();
    for file in ["constants.py", "measured/coffee.json", "measured/freezer.json"] {
        let path = folder.path().join("course").join(file);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::copy(source().join("course").join(file), path).unwrap();
    }
    folder
}

/// The exit code and the report of a check of the folder. Results of listings are stored there.
fn check(folder: &Path) -> (i32, Value) {
    let mut command = program(folder, &["check", ".", "--listings", "--format", "json"]);
    let output = command.env("LABSPEC_CACHE", folder.join("cache")).output().unwrap();
    let report = serde_json::from_slice(&output.stdout);
    let report = report.unwrap_or_else(|e| panic!("{e}: {}", String::from_utf8_lossy(&output.stderr)));
    (output.status.code().unwrap(), report)
}

/// The places of the digits of all displayed outputs: of the fences that are not programs, and of the bodies of the tables.
fn output_digits(text: &str) -> Vec<usize> {
    let (mut fence, mut in_body, mut at) = (None, false, 0);
    let mut all = Vec::new();
    for line in text.split_inclusive('\n') {
        let is_table = fence.is_none() && line.starts_with('|');
        match (line.strip_prefix("```"), fence) {
            (Some(language), None) => fence = Some(!language.starts_with("python")),
            (Some(_), Some(_)) => fence = None,
            _ if fence == Some(true) || is_table && in_body => {
                let digits = line.bytes().enumerate().filter(|(_, b)| b.is_ascii_digit());
                all.extend(digits.map(|(i, _)| at + i));
            }
            _ => {}
        }
        in_body = is_table && (in_body || line.starts_with("|-"));
        at += line.len();
    }
    all
}

/// Copies of a text with one changed digit: one more, and one less. Those are the changes that a rounding could hide.
fn planted(text: &str) -> Vec<(usize, String)> {
    let mut all = Vec::new();
    for at in output_digits(text) {
        let digit = text.as_bytes()[at] - b'0';
        for other in [(digit + 1) % 10, (digit + 9) % 10] {
            let mut wrong = text.to_string();
            wrong.replace_range(at..at + 1, &other.to_string());
            all.push((at, wrong));
        }
    }
    all
}

#[test]
fn the_displayed_outputs_of_the_lessons_are_right() {
    if !needs("python3") {
        return;
    }
    let folder = folder();
    for (name, text) in lessons() {
        std::fs::write(folder.path().join(format!("{name}.md")), text).unwrap();
    }
    let (code, report) = check(folder.path());
    let listings = &report["summary"]["claims"]["listing"];
    assert_eq!((code, report["findings"].as_array().unwrap().len()), (0, 0), "{:#}", report["findings"]);
    assert_eq!(listings["simulated"], 13, "{listings}");
    assert_eq!(report["lessons"].as_array().unwrap().len(), 6);
}

#[test]
fn every_changed_digit_of_an_output_is_found_at_its_place() {
    if !needs("python3") {
        return;
    }
    let folder = folder();
    let mut changes = BTreeMap::new();
    for (name, text) in lessons() {
        let all = planted(&text);
        assert!(all.len() > 100, "{name} displays few digits");
        for (i, (at, wrong)) in all.into_iter().enumerate() {
            let file = format!("{name}-{i:04}.md");
            std::fs::write(folder.path().join(&file), &wrong).unwrap();
            changes.insert(file, (at, wrong));
        }
    }
    let (code, report) = check(folder.path());
    assert_eq!(code, 1);
    let mut undetected: BTreeSet<&str> = changes.keys().map(String::as_str).collect();
    let findings = report["findings"].as_array().unwrap();
    for finding in findings {
        let file = finding["file"].as_str().unwrap().trim_start_matches("./");
        let (at, text) = &changes[file];
        let [start, end] = ["start", "end"].map(|key| finding[key].as_u64().unwrap() as usize);
        let marked = &text[start..end];
        assert!((start..end).contains(at), "{file}: the change is at {at}: {finding}");
        assert!(!marked.contains(char::is_whitespace), "{file}: `{marked}` is more than a word");
        assert_eq!(finding["code"], "listing-output", "{finding}");
        assert!(undetected.remove(file), "{file} has two findings: {finding}");
    }
    assert!(undetected.is_empty(), "changes without a finding: {undetected:?}");
    assert_eq!(report["summary"]["claims"]["listing"]["false"], findings.len());
}

/// A lesson with one changed digit fails alone, too: the exit code is 1.
#[test]
fn one_changed_digit_fails_a_check() {
    if !needs("python3") {
        return;
    }
    for (name, text) in lessons() {
        let folder = folder();
        let all = planted(&text);
        let (_, wrong) = &all[all.len() / 2];
        std::fs::write(folder.path().join("lesson.md"), wrong).unwrap();
        let (code, report) = check(folder.path());
        let count = &report["summary"]["claims"]["listing"];
        assert!(code == 1 && count["false"] == 1, "{name}: {code} {count}");
    }
}
