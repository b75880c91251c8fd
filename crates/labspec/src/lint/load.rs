//! Loads lessons: reads them and applies the structural rules.

use super::ModelFolder;
use crate::finding::{self, Finding, InFile};
use crate::rules;
use crate::source::{BadText, PathQuery, SourceFile, Sources};
use crate::spec::{LabAddress, Lesson, Other, Verify, VerifyLab, read_lesson_in, read_other};
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Maximum number of findings per file. After fixing the first ones, the others appear.
pub const MAX_FINDINGS: usize = 1000;

/// Reads a lesson (Markdown) or, when the path ends in `.json`, a lab, a quiz or a list of them, and checks its structure.
/// Nothing is run. This function never fails; errors are findings.
///
/// Only the text is given: other lessons that it names are not read ([`load_lesson_at`] reads them).
pub fn load_lesson(file: SourceFile, models: &ModelFolder) -> Lesson {
    let path = PathBuf::from(&**file.path());
    load_lesson_at(file, &path, &Sources::default(), models)
}

/// The only loader: loads the lesson at this path with its related files from `sources`: the labs of other lessons that it
/// names, the files to which it links, its snapshot. Programs, editors and checks from memory differ only in their sources.
pub fn load_lesson_at(file: SourceFile, path: &Path, sources: &Sources, models: &ModelFolder) -> Lesson {
    let mut lesson = read_lesson_in(file, Some((path, sources)));
    let mut findings = super::check_rules(&lesson, models);
    rules::dead_link::check_files(&lesson, path, sources, &mut findings);
    withhold_fixes(&lesson, &mut findings);
    remove_effects_of_fences(&lesson, &mut findings);
    lesson.findings = findings.into_iter().map(|f| f.at(&lesson.file)).collect();
    finding::sort(&mut lesson.findings);
    limit(&mut lesson);
    lesson.snapshot = read_snapshot(path, sources);
    lesson.others = read_others(&lesson, path, sources);
    lesson
}

/// Loads another text of a lesson with the same related files.
pub fn reload_lesson(lesson: &Lesson, text: &str, models: &ModelFolder) -> Lesson {
    let file = SourceFile::new(lesson.file.path().clone(), text);
    let loaded = match &lesson.place {
        Some((path, sources)) => load_lesson_at(file, path, sources, models),
        None => load_lesson(file, models),
    };
    Lesson { conventions: lesson.conventions.clone(), ..loaded }
}

/// Keeps the first findings of a file that has too many.
fn limit(lesson: &mut Lesson) {
    if lesson.findings.len() <= MAX_FINDINGS {
        return;
    }
    let more = lesson.findings.len() - MAX_FINDINGS;
    lesson.findings.truncate(MAX_FINDINGS);
    let end = lesson.file.text().len();
    lesson.findings.push(
        Finding::new(rules::LESSON_LIMIT, end..end, format!("{more} more findings are not listed"))
            .help("fix the first ones, then check again")
            .at(&lesson.file),
    );
}

/// Removes fixes inside a block with invalid JSON: they assume valid JSON and could damage it further. Fixes of the JSON
/// itself are kept.
pub fn withhold_fixes(lesson: &Lesson, findings: &mut [Finding]) {
    let in_broken = |f: &&mut Finding| f.fix.as_ref().is_some_and(|fix| lesson.is_broken(&fix.span));
    for finding in findings.iter_mut().filter(in_broken) {
        if ![rules::JSON_SYNTAX.code, rules::TYPOGRAPHIC_QUOTE.code].contains(&finding.code) {
            finding.fix = None;
        }
    }
}

/// Removes the findings about labs that are missing because their fences are damaged. A number beyond all labs and damaged fences is
/// a mistake of its own.
fn remove_effects_of_fences(lesson: &Lesson, findings: &mut Vec<Finding>) {
    let is_of_fence = |f: &Finding| {
        [rules::FENCE_LISTING.code, rules::FENCE_NAME.code, rules::FENCE_MISSING.code].contains(&f.code)
    };
    let damaged = findings.iter().filter(|f| is_of_fence(f)).count();
    if damaged == 0 {
        return;
    }
    let is_damaged = |f: &Finding| {
        let number =
            lesson.file.slice(f.span.clone()).strip_prefix('#').and_then(|n| n.parse::<usize>().ok());
        number.is_none_or(|n| n <= lesson.labs.len() + damaged)
    };
    findings.retain(|f| f.code != rules::UNKNOWN_LAB.code || !is_damaged(f));
}

/// Reads a lesson or a JSON file in any encoding. A file that is not UTF-8 has a finding with the position, and is checked
/// with replacement characters.
///
/// # Errors
/// A message for the author: the file cannot be read, is not a regular file, or is too large.
pub fn load_lesson_file(path: &Path, models: &ModelFolder) -> Result<Lesson, String> {
    let (file, bad) = SourceFile::read_lossy(path)?;
    Ok(load_bytes(file, bad, path, &Sources::Disk, models))
}

/// Maximum number of bytes of other lessons that are searched for the labs that one lesson names. Each name counts the
/// bytes of its lesson.
const MAX_OTHER_LESSONS: u64 = 256 << 20;
/// Maximum number of bytes of a lesson whose labs another one names.
const MAX_OTHER_LESSON: u64 = 4 << 20;

/// The labs of other lessons that this one names.
fn read_others(lesson: &Lesson, path: &Path, sources: &Sources) -> Vec<Other> {
    let mut texts: BTreeMap<PathBuf, Result<String, String>> = BTreeMap::new();
    let place = sources.followed(path);
    let folder = place.parent().unwrap_or(Path::new(""));
    let mut left = MAX_OTHER_LESSONS;
    let named = lesson.verifies().flat_map(Verify::labs).filter_map(|lab| match lab {
        VerifyLab::Elsewhere(text, file, address) => Some((text.span(), file, address)),
        _ => None,
    });
    let mut read = |(span, file, address): (Range<usize>, &String, &LabAddress)| {
        let there = folder.join(file);
        let displayed_path = there.display().to_string();
        // Absolute paths are refused, because an untrusted lesson could name any file of this machine.
        let inside = Path::new(file).is_relative();
        let cached = texts.entry(there.clone());
        let found = match inside {
            true => cached.or_insert_with(|| read_other_file(path, &there, sources)).clone(),
            false => Err(NOT_A_RELATIVE_PATH.into()),
        };
        let found = found.and_then(|text| {
            left = left
                .checked_sub(text.len() as u64)
                .ok_or("this lesson names too many labs of long lessons")?;
            Ok(text)
        });
        let (text, lab) = match found {
            Ok(text) => {
                let lab = read_other(SourceFile::new(file.as_str(), text.as_str()), address, span.clone());
                (text, lab)
            }
            Err(why) => (String::new(), Err(why)),
        };
        Other { span, path: displayed_path, text, lab }
    };
    named.map(&mut read).collect()
}

const NOT_A_RELATIVE_PATH: &str = "a lesson must be named by its path from this one";

/// The text of another lesson, which must use the same model folder.
fn read_other_file(lesson_path: &Path, other: &Path, sources: &Sources) -> Result<String, String> {
    if !is_lesson(other) {
        return Err("a lab must be in a lesson (.md) or in a JSON file".into());
    }
    let models = |path: &Path| sources.place(PathQuery::Models, path, || ModelFolder::find_near(path));
    if models(lesson_path) != models(other) {
        return Err("that lesson has another model folder".into());
    }
    sources.text(other, MAX_OTHER_LESSON, "a lesson")
}

fn is_lesson(path: &Path) -> bool {
    path.extension().is_some_and(|e| e == "md" || e == "json")
}

/// The path of the snapshot of a lesson: beside it.
pub fn snapshot_path(path: &Path) -> PathBuf {
    let mut name = path.as_os_str().to_os_string();
    name.push(SNAPSHOT);
    PathBuf::from(name)
}

/// The suffix of a snapshot after the name of its lesson.
pub const SNAPSHOT: &str = ".snap";
/// Maximum number of bytes of a snapshot.
const MAX_SNAPSHOT: u64 = 4 << 20;

fn read_snapshot(path: &Path, sources: &Sources) -> Option<Result<SourceFile, String>> {
    let path = snapshot_path(path);
    // A broken link exists, but cannot be read.
    sources.has(&path).then_some(())?;
    let text = sources.text(&path, MAX_SNAPSHOT, "a snapshot");
    Some(text.map(|text| SourceFile::new(path.display().to_string(), text)))
}

fn load_bytes(
    file: SourceFile,
    bad: Option<BadText>,
    path: &Path,
    sources: &Sources,
    models: &ModelFolder,
) -> Lesson {
    let mut lesson = load_lesson_at(file, path, sources, models);
    if let Some(bad) = bad {
        let finding = rules::not_utf8::not_utf8(bad).at(&lesson.file);
        lesson.findings.push(finding);
        // The offsets differ from those of the bytes, and would change when the file is saved in another encoding.
        lesson.findings.iter_mut().for_each(|f| f.fix = None);
        finding::sort(&mut lesson.findings);
    }
    lesson
}

#[cfg(test)]
mod tests {
    use super::*;

    fn load(bytes: &[u8]) -> Lesson {
        let (file, bad) = SourceFile::from_bytes("t.md", bytes);
        load_bytes(file, bad, Path::new("t.md"), &Sources::default(), &ModelFolder::with_names(["ball"]))
    }

    fn places(lesson: &Lesson) -> Vec<(&'static str, usize, usize)> {
        let place = |f: &Finding| {
            let position = lesson.file.position(f.span.start);
            (f.code, position.line, position.column)
        };
        lesson.findings.iter().map(place).collect()
    }

    #[test]
    fn a_latin_1_lesson_is_named_and_checked() {
        let lesson = load(b"# A caf\xe9\n\n```lab simlab\n{\"model\": \"bal\", \"title\": \"\xfc\"}\n```\n");
        assert_eq!(places(&lesson), [("not-utf8", 1, 8), ("unknown-model", 4, 12)]);
        assert!(lesson.findings[0].message.contains("0xE9; in Latin-1 it is `é`"));
    }

    #[test]
    fn a_utf_16_lesson_is_named_and_checked() {
        let text = "```lab simlab\n{\"model\": \"bal\"}\n```\n";
        for from in [u16::to_le_bytes, u16::to_be_bytes] {
            let units = std::iter::once(0xfeff).chain(text.encode_utf16());
            let bytes: Vec<u8> = units.flat_map(from).collect();
            let lesson = load(&bytes);
            assert_eq!(places(&lesson), [("not-utf8", 1, 1), ("unknown-model", 2, 12)]);
            assert_eq!(lesson.findings[0].message, "this file is UTF-16");
        }
    }

    #[test]
    fn a_path_that_is_not_a_file_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        assert!(load_lesson_file(folder.path(), &ModelFolder::unknown()).unwrap_err().contains("not a file"));
        std::fs::write(folder.path().join("a.md"), b"\xe9").unwrap();
        let lesson = load_lesson_file(&folder.path().join("a.md"), &ModelFolder::unknown()).unwrap();
        assert_eq!(places(&lesson), [("not-utf8", 1, 1)]);
    }
}
